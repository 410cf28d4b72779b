//! Blocks of a list, one by one: what each does to the state and to the scene.

use super::super::lights::ListLights;
use super::super::scene::Scene;
use super::ListRunner;
use super::target::Target;
use crate::event::{Event, EventSink};
use crate::geometry::{Affine, Camera, Clip, Mark, Shading, Sphere};
use crate::list::{
    Bounds, Flow, Id, Instruction, ListError, Overlay, Reason, State, Step, Texture, TextureSlots,
    Window, Words, read_block,
};
use crate::pipeline::{MarkOf, Pipeline};
use crate::player::{ListCoordinate, Out, Refusal};

impl<C: ListCoordinate, L: ListLights> ListRunner<'_, '_, C, L> {
    /// Does one block.
    pub(super) fn execute<'w, P: Pipeline>(
        &mut self,
        words: impl Words<'w>,
        instruction: Instruction,
        scene: &mut Scene<'_, P>,
        events: &mut impl EventSink,
    ) -> Result<Step, ListError> {
        self.counts.blocks += 1;
        // State comes in groups and is combined once, before the first block that draws.
        let draws = !matches!(instruction, Instruction::State(_) | Instruction::Flow(_));
        if self.stale && draws {
            self.renew::<P>(events);
        }
        let light = self.lights.on(&self.material);
        let mut target = Target {
            scene,
            instance: self.instance.lit_by(light.filter(|_| !self.material.unlit)),
            opacity: self.material.opacity,
            texture: self.texture.map(|t| (t, self.settings.quality)),
            events,
            counts: &mut self.drawn,
            offset: self.walker.offset(),
        };
        let mut out = Out {
            textured: P::Shading::TEXTURED,
            sides: target.sides(),
            block: target.offset,
            draw: &mut |mesh| target.draw(mesh),
        };
        let format = self.walker.format();
        let done = match instruction {
            Instruction::Short(run) | Instruction::Quads(run) | Instruction::Points(run) => {
                (self.gather).run(words, format, run, self.point_size, &mut out)
            }
            Instruction::Long(run) => {
                self.gather.pause(words, &mut out);
                self.long.draw(words, run, &mut target);
                Ok(())
            }
            Instruction::Table(run) => self.gather.table(words, format, run, &mut out),
            Instruction::Indexed(run) => self.gather.indexed(words, run, &mut out),
            Instruction::State(state) => return self.state(words, state, scene, events),
            Instruction::Flow(Flow::LoadTexture { number, at }) => {
                self.flush(words, scene, events);
                self.load(words, number, at, events);
                Ok(())
            }
            _ => {
                self.unimplemented(events);
                Ok(())
            }
        };
        let lost = match (done, instruction) {
            (Ok(()), _) => return Ok(Step::Do(instruction)),
            (Err(Refusal::Index { index, count }), _) => {
                let reason = Reason::Index { index, count };
                return Err(self.walker.fail(Id::Indexed, reason));
            }
            (Err(Refusal::Fine), _) => {
                self.unimplemented(events);
                return Ok(Step::Do(instruction));
            }
            (Err(Refusal::Table), Instruction::Indexed(run)) => run.header.count,
            (Err(Refusal::Indices), Instruction::Indexed(_)) => 1,
            (Err(_), _) => 0,
        };
        self.notice(events, Event::Full, u32::from(lost));
        Ok(Step::Do(instruction))
    }

    /// Gives a number to the texture that is defined elsewhere in the list; the walker has seen
    /// that one is there.
    fn load<'w>(
        &mut self,
        words: impl Words<'w>,
        number: u8,
        at: u32,
        events: &mut impl EventSink,
    ) {
        let block = read_block(words, at, self.walker.format());
        if let Ok(Instruction::State(State::Texture(texture))) = block.map(|b| b.instruction) {
            let slots = TextureSlots(self.textures);
            if !slots.texture(&Texture { number, ..texture }) {
                self.notice(events, Event::Full, 0);
            }
            self.stale = true;
        }
    }

    /// Keeps an overlay for those who draw the lines.
    fn overlay(&mut self, overlay: &Overlay, events: &mut impl EventSink) {
        let slots = self.overlays;
        let colours = match overlay.form.is_indexed() {
            true => TextureSlots(self.textures).colours(overlay.palette),
            false => Some((0, 1)),
        };
        match colours {
            Some(colours) if !slots.0.is_empty() => {
                if !slots.push(overlay, colours) {
                    self.notice(events, Event::Full, 0);
                }
            }
            // Nobody paints them, or there is no such palette.
            _ => self.unimplemented(events),
        }
    }

    /// Passes over what a sphere holds that cannot be seen.
    fn bounds<'w, P: Pipeline>(
        &mut self,
        words: impl Words<'w>,
        bounds: &Bounds,
        scene: &Scene<'_, P>,
    ) {
        let (sphere, scale) = (Sphere::from(bounds), Affine::scale_of(bounds));
        let model = scale.then(&self.settings.instance.model);
        if scene.is_outside(&sphere, &model) {
            let to = self.walker.position().wrapping_add(bounds.words);
            // Of a ring, what is not yet there cannot be passed over.
            if self.walker.jump(words, to) {
                self.counts.skipped += 1;
                self.counts.skipped_words += bounds.words;
            }
        }
    }

    /// Takes new state; what was gathered is drawn with the old one.
    fn state<'w, P: Pipeline>(
        &mut self,
        words: impl Words<'w>,
        state: State,
        scene: &mut Scene<'_, P>,
        events: &mut impl EventSink,
    ) -> Result<Step, ListError> {
        match state {
            State::Head(_) | State::Format(_) => return Ok(Step::Passed),
            State::Bounds(bounds) => {
                self.bounds(words, &bounds, scene);
                return Ok(Step::Passed);
            }
            _ => self.flush(words, scene, events),
        }
        let screen = scene.screen();
        match state {
            State::Matrix(matrix) => self.matrix = Affine::from(&matrix),
            State::Light { number, light } => {
                if !self.lights.set(number, Some(light)) {
                    self.unimplemented(events);
                }
            }
            State::LightOff { number } => {
                self.lights.set(number, None);
            }
            State::Material(material) => {
                if (material.opacity != 255 && !P::Shading::COMPOSITED)
                    || (material.specular != [0; 3] && !L::HIGHLIGHTS)
                    || (material.texture.is_some() && !P::Shading::TEXTURED)
                {
                    self.unimplemented(events);
                }
                self.material = material;
            }
            State::Camera(_) if !self.settings.camera => return Ok(Step::Violation),
            State::Camera(camera) => match Camera::listed(&camera, screen.height()) {
                Ok(camera) => scene.set_camera(&camera),
                Err(_) => return Err(self.walker.fail(Id::State, Reason::Camera)),
            },
            State::Window(window) => {
                let all = Window::all(screen.width(), screen.height());
                if !self.settings.window.unwrap_or(all).contains(window) {
                    return Ok(Step::Violation);
                }
                if MarkOf::<P>::CUTS {
                    self.window = Some(window);
                    scene.cut_to(Clip::Inside(window));
                } else if window != all {
                    self.unimplemented(events);
                }
            }
            State::PointSize(size) => self.point_size = size,
            // Texels are drawn from where they lie.
            State::Texture(texture)
                if P::Shading::TEXTURED && words.slice(texture.at, texture.words()).is_some() =>
            {
                if !TextureSlots(self.textures).texture(&texture) {
                    self.notice(events, Event::Full, 0);
                }
            }
            State::Palette(palette)
                if (P::Shading::TEXTURED || !self.overlays.0.is_empty())
                    && words.slice(palette.at, u32::from(palette.count)).is_some() =>
            {
                if !TextureSlots(self.textures).palette(&palette) {
                    self.notice(events, Event::Full, 0);
                }
            }
            State::Overlay(overlay) if words.slice(overlay.at, overlay.words()).is_some() => {
                self.overlay(&overlay, events);
            }
            _ => self.unimplemented(events),
        }
        self.stale = true;
        Ok(Step::Passed)
    }
}
