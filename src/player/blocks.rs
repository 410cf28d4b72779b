//! Blocks of a list, one by one: what each does to the draw call, and what is refused.

use super::gather::Gather;
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

impl<'n, 'm, 't, L: Look, C: Coordinate + Place, W: Words<'t>> Stage<'_, 'n, 'm, 't, L, C, W> {
    /// Does one block.
    pub(super) fn execute(&mut self, instruction: Instruction) -> Result<Step, ListError> {
        let counts = &mut self.player.counts;
        counts.blocks = counts.blocks.saturating_add(1);
        let (id, done) = match instruction {
            Instruction::State(state) => (Id::State, self.change(state)),
            Instruction::Flow(Flow::LoadTexture { number, at }) => {
                (Id::Flow, self.load(number, at).map(|()| Step::Passed))
            }
            _ => match instruction.run() {
                Some(run) => (run.header.id, self.take(run).map(|()| Step::Passed)),
                // The walker keeps the others.
                None => (Id::Later, Ok(Step::Passed)),
            },
        };
        done.map_err(|reason| self.player.walker.fail(id, reason))
    }

    /// Takes vertices or faces.
    fn take(&mut self, run: Run) -> Result<(), Reason> {
        let id = run.header.id;
        let is_volume = self.player.state.draw.is_volume();
        if is_volume && matches!(id, Id::Points | Id::Long) {
            return Err(Reason::Missing(Missing::Shadows));
        }
        if id == Id::Long {
            return self.take_long(run);
        }
        self.find_texture()?;
        let player = &*self.player;
        if id != Id::Indexed {
            let layout = Layout::new(player.walker.format(), run.header);
            if player.state.draw.lamps.is_some() && layout.colour.is_some() {
                return Err(Reason::Missing(Missing::LightAtVertices));
            }
        } else if player.state.texture.is_some() && player.gather.lacks_table_places() {
            return Err(Reason::Lent(Lent::Places));
        }
        let words = self.words;
        let (drawer, gather) = self.drawer();
        drawer.gather(words, |out| match id {
            Id::Table => gather.table(run, out),
            Id::Indexed => gather.indexed(run, out),
            _ => gather.run(run, out),
        })?
    }

    /// Draws vertices that were set up beforehand; what was gathered before them first.
    fn take_long(&mut self, run: Run) -> Result<(), Reason> {
        if self.player.state.draw.lamps.is_some() {
            return Err(Reason::Missing(Missing::LightAtVertices));
        }
        self.draw()?;
        self.player.gather.pause();
        self.find_texture()?;
        let words = self.words;
        let (mut drawer, gather) = self.drawer();
        let count = u32::from(run.header.count);
        drawer.counts.vertices = drawer.counts.vertices.saturating_add(count);
        let (colour, sides) = (drawer.state.draw.colour, drawer.sides());
        let has_alphas = !gather.alphas.is_empty();
        (gather.long).take(words, run, colour, sides, |triangles, alphas| {
            let alphas = if has_alphas { alphas } else { &[] };
            drawer.draw_long(triangles, alphas, run.header);
        });
        drawer.done()
    }

    /// Draws what was gathered.
    pub(super) fn flush(&mut self) -> Result<(), ListError> {
        self.draw()
            .map_err(|reason| self.player.walker.fail(Id::Flow, reason))
    }

    fn draw(&mut self) -> Result<(), Reason> {
        let words = self.words;
        let (drawer, gather) = self.drawer();
        drawer.gather(words, |out| gather.flush(out))
    }

    /// Who draws, and what was gathered.
    fn drawer(&mut self) -> (Drawer<'_, 'n, 'm, 't, L, C>, &mut Gather<'m, C>) {
        let player = &mut *self.player;
        let drawer = Drawer {
            scene: self.scene.as_deref_mut(),
            state: &player.state,
            settings: &player.settings,
            walker: &player.walker,
            counts: &mut player.counts,
            events: &mut *self.events,
            lights: player.lights.as_deref(),
            casts: player.casts.as_mut(),
            lack: None,
        };
        (drawer, &mut player.gather)
    }

    /// The texture that the material names: of the settings, or of the list with the palette that it names now.
    #[inline]
    fn find_texture(&mut self) -> Result<(), Reason> {
        let player = &mut *self.player;
        if !core::mem::take(&mut player.state.is_stale) {
            return Ok(());
        }
        player.state.texture = None;
        let Some(number) = player.state.material.texture.filter(|_| L::TEXTURED) else {
            return Ok(());
        };
        if let Some(Some(texture)) = player.settings.textures.get(usize::from(number)) {
            player.state.texture = Some(Listed {
                texture,
                is_translucent: texture.mask().is_some(),
            });
            return Ok(());
        }
        let pair = player.names.pair(number)?;
        let (dithers, sampling) = (player.state.draw.dither, player.settings.sampling);
        let texture = player
            .shelf
            .texture::<L::Pixel>(self.words, pair, dithers, sampling)?;
        player.state.texture = Some(texture);
        Ok(())
    }

    /// Gives a number to the texture that is defined elsewhere in the list; the walker has seen
    /// that one is there.
    fn load(&mut self, number: u8, at: u32) -> Result<(), Reason> {
        self.draw()?;
        let block = read_block(self.words, at, self.player.walker.format());
        match block.map(|b| b.instruction) {
            Ok(Instruction::State(State::Texture(t))) => self.define(&Texture { number, ..t }),
            _ => Ok(()),
        }
    }

    /// Gives a texture its number.
    fn define(&mut self, texture: &Texture) -> Result<(), Reason> {
        self.player.state.is_stale = true;
        let is_kept = !L::TEXTURED || self.player.names.texture(texture);
        is_kept.then_some(()).ok_or(Reason::Lent(Lent::Names))
    }

    /// Passes over what a sphere holds that cannot be seen.
    fn skip(&mut self, bounds: &Bounds) {
        let Some(scene) = &self.scene else { return };
        let Some(camera) = &scene.camera else { return };
        let (sphere, scale) = (Sphere::from(bounds), Affine::scale_of(bounds));
        let model = scale.then(&self.player.settings.draw.model);
        if self.passes_over() && sphere.is_outside(camera, scene.screen, &scene.lines, &model) {
            self.pass_over(bounds.words);
        }
    }

    /// Passes over faces that are all seen from behind.
    fn skip_behind(&mut self, cone: &Cone) {
        let Some(scene) = &self.scene else { return };
        let Some(camera) = &scene.camera else { return };
        let is_asked = self.passes_over();
        let state = &mut self.player.state;
        if !state.draw.is_one_sided() || !is_asked {
            return;
        }
        let find = || Eye::new(&state.draw.model, &camera.view);
        let eye = *state.eye.get_or_insert_with(find);
        if eye.is_some_and(|eye| eye.is_behind(&Meshlet::from(cone))) {
            self.pass_over(cone.words);
            self.player.gather.lacks_faces();
        }
    }

    /// Whether what is out of sight may be passed over: it casts no shadow into what is seen.
    fn passes_over(&self) -> bool {
        self.player.settings.casting().is_empty()
    }

    /// Goes on behind so many words. Of a ring, what is not yet there cannot be passed over.
    fn pass_over(&mut self, count: u32) {
        let walker = &mut self.player.walker;
        let to = walker.position().wrapping_add(count);
        if walker.jump(self.words, to) {
            let counts = &mut self.player.counts;
            counts.skipped = counts.skipped.saturating_add(1);
            counts.skipped_words = counts.skipped_words.saturating_add(count);
        }
    }

    /// Takes new state; what was gathered is drawn with the old one.
    fn change(&mut self, state: State) -> Result<Step, Reason> {
        match state {
            State::Head(_) | State::Format(_) | State::Bounds(_) | State::Cone(_) => {}
            _ => self.draw()?,
        }
        let player = &mut *self.player;
        match state {
            State::Head(_) | State::Format(_) => {}
            State::Bounds(bounds) => self.skip(&bounds),
            State::Cone(cone) => self.skip_behind(&cone),
            State::Matrix(m) => player.state.place(Some(Affine::from(&m)), &player.settings),
            State::Light { number, light } => self.light(number, Some(light))?,
            State::LightOff { number } => self.light(number, None)?,
            State::Material(material) => self.material(material)?,
            State::Camera(_) if !player.settings.camera => return Ok(Step::Violation),
            State::Camera(camera) => {
                let camera = Camera::listed(&camera, self.screen.height());
                let camera = camera.map_err(|_| Reason::Camera)?;
                if let Some(scene) = &mut self.scene {
                    scene.camera = Some(camera);
                }
                player.state.eye = None;
            }
            State::Window(window) => return self.window(window),
            State::Texture(texture) => self.define(&texture)?,
            State::Palette(palette) => {
                let is_used = L::TEXTURED || !player.overlays.0.is_empty();
                if is_used && !player.names.palette(&palette) {
                    return Err(Reason::Lent(Lent::Names));
                }
                player.state.is_stale = true;
            }
            State::Overlay(overlay) => self.overlay(&overlay)?,
            State::PointSize(size) => player.state.point_size = size,
        }
        Ok(Step::Passed)
    }

    /// Keeps an overlay for those who draw the lines.
    fn overlay(&self, overlay: &Overlay) -> Result<(), Reason> {
        let (overlays, names) = (self.player.overlays, self.player.names);
        if overlays.0.is_empty() {
            return Err(Reason::Lent(Lent::Overlays));
        }
        let colours = names.colours_of(overlay.form, overlay.palette);
        let (colours, count) = colours.ok_or(Reason::NoPalette(overlay.palette))?;
        if (self.words.slice(overlay.at, overlay.words())).is_none() {
            return Err(Reason::Missing(Missing::TexelsInPieces));
        }
        let is_kept = overlays.push(overlay, colours, count);
        is_kept.then_some(()).ok_or(Reason::Lent(Lent::Overlays))
    }

    fn light(&mut self, number: u8, light: Option<LightWords>) -> Result<(), Reason> {
        let player = &mut *self.player;
        if light.is_some() && player.state.draw.lamps.is_some() {
            return Err(Reason::Missing(Missing::LightAtVertices));
        }
        let room = player.lights.as_deref_mut();
        lights::set(room, &mut player.state, number, light)
    }

    fn material(&mut self, material: Material) -> Result<(), Reason> {
        // What lights of the settings fall on is for those to say, and so is light at pixels.
        let state = &mut self.player.state;
        let is_theirs = state.lights.is_some() || state.draw.lamps.is_some();
        if material.specular != [0; 3] && (is_theirs || self.player.lights.is_none()) {
            return Err(Reason::Missing(Missing::Highlights));
        }
        if material.texture.is_some() && !L::TEXTURED {
            return Err(Reason::Missing(Missing::Textures));
        }
        state.material(material);
        Ok(())
    }

    /// Cuts to a window, if it is one that was granted.
    fn window(&mut self, window: Window) -> Result<Step, Reason> {
        let all = Window::all(self.screen.width(), self.screen.height());
        let Player {
            state, settings, ..
        } = &mut *self.player;
        if !settings.window.unwrap_or(all).contains(window) {
            return Ok(Step::Violation);
        }
        if settings.draw.scissor.is_some() && window != all {
            return Err(Reason::Missing(Missing::SecondScissor));
        }
        state.cut(settings, Some(window).filter(|_| window != all));
        Ok(Step::Passed)
    }
}
