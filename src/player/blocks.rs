//! Blocks of a list, one by one: what each does to the draw call, and what is refused.

use super::lights;
use super::play::{Player, Stage};
use super::state::Drawer;
use super::textures::Listed;
use crate::geometry::{Affine, Camera, Coordinate, Eye, Meshlet, Sphere};
use crate::list::{
    Bounds, Cone, Flow, Id, Instruction, Layout, Lent, LightWords, ListError, Material, Missing,
    Overlay, Place, Reason, Run, State, Step, Texture, Window, Words, read_block,
};
use crate::look::Look;
use crate::scene::Shadow;

impl<'t, L: Look, C: Coordinate + Place> Player<'_, 't, L, C> {
    /// Does one block.
    pub(super) fn execute(
        &mut self,
        words: impl Words<'t>,
        instruction: Instruction,
        stage: &mut Stage<'_, '_, 't, L>,
    ) -> Result<Step, ListError> {
        self.counts.blocks = self.counts.blocks.saturating_add(1);
        let (id, done) = match instruction {
            Instruction::State(state) => (Id::State, self.change(words, state, stage)),
            Instruction::Flow(Flow::LoadTexture { number, at }) => {
                (Id::Flow, self.load(words, number, at, stage))
            }
            _ => match instruction.run() {
                Some(run) => (run.header.id, self.take(words, run, stage)),
                // The walker keeps the others.
                None => (Id::Later, Ok(Step::Passed)),
            },
        };
        done.map_err(|reason| self.walker.fail(id, reason))
    }

    /// Takes vertices or faces.
    fn take(
        &mut self,
        words: impl Words<'t>,
        run: Run,
        stage: &mut Stage<'_, '_, 't, L>,
    ) -> Result<Step, Reason> {
        let id = run.header.id;
        let is_volume = matches!(self.state.draw.shadow, Some(Shadow::Volume(_)));
        if is_volume && matches!(id, Id::Points | Id::Long) {
            return Err(Reason::Missing(Missing::Shadows));
        }
        if id == Id::Long {
            return self.take_long(words, run, stage);
        }
        self.find_texture(words)?;
        let format = self.walker.format();
        if id != Id::Indexed {
            let layout = Layout::new(format, run.header);
            if self.state.draw.lamps.is_some() && layout.colour.is_some() {
                return Err(Reason::Missing(Missing::LightAtVertices));
            }
        } else if self.state.texture.is_some() && self.gather.lacks_table_places() {
            return Err(Reason::Lent(Lent::Places));
        }
        let offset = self.walker.offset();
        let drawer = Drawer::of(&self.state, &self.settings, &mut self.counts, stage, offset)
            .lit_by(self.lights.as_deref());
        let (gather, point_size) = (&mut self.gather, self.state.point_size);
        let done = drawer.gather(self.casts.as_mut(), |out| match id {
            Id::Table => gather.table(words, format, run, out),
            Id::Indexed => gather.indexed(words, run, out),
            _ => gather.run(words, format, run, point_size, out),
        })?;
        done.map(|()| Step::Passed)
    }

    /// Draws vertices that were set up beforehand; what was gathered before them first.
    fn take_long(
        &mut self,
        words: impl Words<'t>,
        run: Run,
        stage: &mut Stage<'_, '_, 't, L>,
    ) -> Result<Step, Reason> {
        if self.state.draw.lamps.is_some() {
            return Err(Reason::Missing(Missing::LightAtVertices));
        }
        self.draw(words, stage)?;
        self.gather.pause();
        self.find_texture(words)?;
        let offset = self.walker.offset();
        let count = u32::from(run.header.count);
        self.counts.vertices = self.counts.vertices.saturating_add(count);
        let mut drawer = Drawer::of(&self.state, &self.settings, &mut self.counts, stage, offset);
        let (colour, sides) = (self.state.draw.colour, drawer.sides());
        let has_alphas = self.has_alphas;
        self.long
            .take(words, run, colour, sides, |triangles, alphas| {
                let alphas = if has_alphas { alphas } else { &[] };
                drawer.draw_long(triangles, alphas, run.header);
            });
        drawer.done().map(|()| Step::Passed)
    }

    /// Draws what was gathered.
    pub(super) fn flush(
        &mut self,
        words: impl Words<'t>,
        stage: &mut Stage<'_, '_, 't, L>,
    ) -> Result<(), ListError> {
        self.draw(words, stage)
            .map_err(|reason| self.walker.fail(Id::Flow, reason))
    }

    fn draw(
        &mut self,
        words: impl Words<'t>,
        stage: &mut Stage<'_, '_, 't, L>,
    ) -> Result<(), Reason> {
        let offset = self.walker.offset();
        let drawer = Drawer::of(&self.state, &self.settings, &mut self.counts, stage, offset)
            .lit_by(self.lights.as_deref());
        drawer.gather(self.casts.as_mut(), |out| self.gather.flush(words, out))
    }

    /// The texture that the material names: of the settings, or of the list with the palette that it names now.
    #[inline]
    fn find_texture(&mut self, words: impl Words<'t>) -> Result<(), Reason> {
        if !core::mem::take(&mut self.state.is_stale) {
            return Ok(());
        }
        self.state.texture = None;
        let Some(number) = self.state.material.texture.filter(|_| L::TEXTURED) else {
            return Ok(());
        };
        if let Some(Some(texture)) = self.settings.textures.get(usize::from(number)) {
            self.state.texture = Some(Listed {
                texture,
                is_translucent: texture.mask().is_some(),
            });
            return Ok(());
        }
        let pair = self.names.pair(number)?;
        let (dithers, sampling) = (self.state.draw.dither, self.settings.sampling);
        let texture = self
            .shelf
            .texture::<L::Pixel>(words, pair, dithers, sampling)?;
        self.state.texture = Some(texture);
        Ok(())
    }

    /// Gives a number to the texture that is defined elsewhere in the list; the walker has seen
    /// that one is there.
    fn load(
        &mut self,
        words: impl Words<'t>,
        number: u8,
        at: u32,
        stage: &mut Stage<'_, '_, 't, L>,
    ) -> Result<Step, Reason> {
        self.draw(words, stage)?;
        let block = read_block(words, at, self.walker.format());
        if let Ok(Instruction::State(State::Texture(texture))) = block.map(|b| b.instruction) {
            self.define(&Texture { number, ..texture })?;
        }
        Ok(Step::Passed)
    }

    /// Gives a texture its number.
    fn define(&mut self, texture: &Texture) -> Result<(), Reason> {
        self.state.is_stale = true;
        let is_kept = !L::TEXTURED || self.names.texture(texture);
        is_kept.then_some(()).ok_or(Reason::Lent(Lent::Names))
    }

    /// Passes over what a sphere holds that cannot be seen.
    fn skip(&mut self, words: impl Words<'t>, bounds: &Bounds, stage: &Stage<'_, '_, 't, L>) {
        let Some(scene) = &stage.scene else { return };
        let Some(camera) = &scene.camera else { return };
        let (sphere, scale) = (Sphere::from(bounds), Affine::scale_of(bounds));
        let model = scale.then(&self.settings.draw.model);
        if self.passes_over() && sphere.is_outside(camera, scene.screen, &scene.lines, &model) {
            self.pass_over(words, bounds.words);
        }
    }

    /// Passes over faces that are all seen from behind.
    fn skip_behind(&mut self, words: impl Words<'t>, cone: &Cone, stage: &Stage<'_, '_, 't, L>) {
        let Some(scene) = &stage.scene else { return };
        let Some(camera) = &scene.camera else { return };
        let draw = &self.state.draw;
        if !draw.is_one_sided() || !self.passes_over() {
            return;
        }
        let find = || Eye::new(&draw.model, &camera.view);
        let eye = *self.state.eye.get_or_insert_with(find);
        if eye.is_some_and(|eye| eye.is_behind(&Meshlet::from(cone))) {
            self.pass_over(words, cone.words);
            self.gather.lacks_faces();
        }
    }

    /// Whether what is out of sight may be passed over: it casts no shadow into what is seen.
    fn passes_over(&self) -> bool {
        self.settings.casting().is_empty()
    }

    /// Goes on behind so many words. Of a ring, what is not yet there cannot be passed over.
    fn pass_over(&mut self, words: impl Words<'t>, count: u32) {
        let to = self.walker.position().wrapping_add(count);
        if self.walker.jump(words, to) {
            let counts = &mut self.counts;
            counts.skipped = counts.skipped.saturating_add(1);
            counts.skipped_words = counts.skipped_words.saturating_add(count);
        }
    }

    /// Takes new state; what was gathered is drawn with the old one.
    fn change(
        &mut self,
        words: impl Words<'t>,
        state: State,
        stage: &mut Stage<'_, '_, 't, L>,
    ) -> Result<Step, Reason> {
        match state {
            State::Head(_) | State::Format(_) | State::Bounds(_) | State::Cone(_) => {}
            _ => self.draw(words, stage)?,
        }
        match state {
            State::Head(_) | State::Format(_) => {}
            State::Bounds(bounds) => self.skip(words, &bounds, stage),
            State::Cone(cone) => self.skip_behind(words, &cone, stage),
            State::Matrix(m) => self.state.place(Some(Affine::from(&m)), &self.settings),
            State::Light { number, light } => self.light(number, Some(light))?,
            State::LightOff { number } => self.light(number, None)?,
            State::Material(material) => self.material(material)?,
            State::Camera(_) if !self.settings.camera => return Ok(Step::Violation),
            State::Camera(camera) => {
                let camera = Camera::listed(&camera, stage.screen.height());
                let camera = camera.map_err(|_| Reason::Camera)?;
                if let Some(scene) = &mut stage.scene {
                    scene.camera = Some(camera);
                }
                self.state.eye = None;
            }
            State::Window(window) => return self.window(window, stage),
            State::Texture(texture) => self.define(&texture)?,
            State::Palette(palette) => {
                let is_used = L::TEXTURED || !self.overlays.0.is_empty();
                if is_used && !self.names.palette(&palette) {
                    return Err(Reason::Lent(Lent::Names));
                }
                self.state.is_stale = true;
            }
            State::Overlay(overlay) => self.overlay(words, &overlay)?,
            State::PointSize(size) => self.state.point_size = size,
        }
        Ok(Step::Passed)
    }

    /// Keeps an overlay for those who draw the lines.
    fn overlay(&self, words: impl Words<'t>, overlay: &Overlay) -> Result<(), Reason> {
        if self.overlays.0.is_empty() {
            return Err(Reason::Lent(Lent::Overlays));
        }
        let colours = match overlay.form.is_indexed() {
            true => self.names.colours(overlay.palette),
            false => Some((0, 1)),
        };
        let (colours, count) = colours.ok_or(Reason::NoPalette(overlay.palette))?;
        if words.slice(overlay.at, overlay.words()).is_none() {
            return Err(Reason::Missing(Missing::TexelsInPieces));
        }
        let is_kept = self.overlays.push(overlay, colours, count);
        is_kept.then_some(()).ok_or(Reason::Lent(Lent::Overlays))
    }

    fn light(&mut self, number: u8, light: Option<LightWords>) -> Result<(), Reason> {
        if light.is_some() && self.state.draw.lamps.is_some() {
            return Err(Reason::Missing(Missing::LightAtVertices));
        }
        lights::set(self.lights.as_deref_mut(), &mut self.state, number, light)
    }

    fn material(&mut self, material: Material) -> Result<(), Reason> {
        // What lights of the settings fall on is for those to say, and so is light at pixels.
        let is_theirs = self.state.lights.is_some() || self.state.draw.lamps.is_some();
        if material.specular != [0; 3] && (is_theirs || self.lights.is_none()) {
            return Err(Reason::Missing(Missing::Highlights));
        }
        if material.texture.is_some() && !L::TEXTURED {
            return Err(Reason::Missing(Missing::Textures));
        }
        self.state.material(material);
        Ok(())
    }

    /// Cuts to a window, if it is one that was granted.
    fn window(&mut self, window: Window, stage: &Stage<'_, '_, 't, L>) -> Result<Step, Reason> {
        let all = Window::all(stage.screen.width(), stage.screen.height());
        if !self.settings.window.unwrap_or(all).contains(window) {
            return Ok(Step::Violation);
        }
        if self.settings.draw.scissor.is_some() && window != all {
            return Err(Reason::Missing(Missing::SecondScissor));
        }
        (self.state).cut(&self.settings, Some(window).filter(|_| window != all));
        Ok(Step::Passed)
    }
}
