//! Executes instruction lists into a scene (H11-H14, H16).
//!
//! [`ListRunner`] walks a list block by block, keeps the state that blocks set, and draws what
//! they hold through [`Scene::draw`], so a list gives the same bits as the same calls. It halts
//! at the list's end, at PAUSE and SYNC, when a ring is empty and when the budget is spent, and
//! goes on where it halted.
//!
//! What a list cannot do (H13): reach the master state, draw to a window that was not granted,
//! jump or read outside itself. A try is an event, and the list goes on or stops, as the settings
//! say. What this pipeline does not have is an event as well, and the rest is drawn: textures where
//! the shading has none, opacity where it is not [`Composited`](crate::pipeline::Composited), several lights
//! and highlights without [`EightLights`](crate::input::EightLights), overlays without slots, and windows that
//! are not the whole picture where surfaces are not [`Windowed`](crate::pipeline::Windowed). Of levels of detail the first is drawn.

mod blocks;
mod long;
mod target;

pub use target::ListMemory;

use super::frame::FrameStats;
use super::instance::Instance;
use super::lights::{ListLights, OneLight};
use super::scene::Scene;
use crate::event::{Event, EventSet, EventSink, Notice};
use crate::geometry::texturing::Quality;
use crate::geometry::{Affine, Clip, Cull, Mark, Shading};
use crate::list::{
    Bound, Budget, Halt, ListCommand, ListControl, ListError, Material, NoTexture, OverlaySlots,
    Step, TextureSlot, TextureSlots, Walker, Window, Words,
};
use crate::pipeline::{MarkOf, Pipeline};
use crate::player::{Gather, ListCoordinate, OnViolation, Out, RunCounts, Unpacked};
use long::LongStrip;
use target::{DrawCounts, Target};

/// What a list starts from, and what it may do.
#[derive(Clone, Copy, Debug, Default)]
pub struct ListSettings<'c> {
    /// The list's world in the application's: its matrices come first, then this one. Culling,
    /// light and colour until the list says otherwise.
    pub instance: Instance,
    /// Whether its cameras count; else they are access violations.
    pub camera: bool,
    /// The part of the picture that it may ask for as its window; `None`: all. In pipelines such as
    /// [`Windowed`](crate::pipeline::Windowed) what it draws is cut to it; in others it is not, and bands confine
    /// it to lines, as they do all that is drawn.
    pub window: Option<Window>,
    /// How far texture places may be off where a block has PRSP; elsewhere [`Quality::Fast`].
    pub quality: Quality,
    /// After an access violation.
    pub on_violation: OnViolation,
    /// Where commands come from, beside [`ListRunner::command`].
    pub control: Option<&'c ListControl>,
}

/// Executes lists.
///
/// `L` says which lights they can have: [`OneLight`], or [`EightLights`](crate::input::EightLights).
pub struct ListRunner<'m, 'c, C = i16, L = OneLight> {
    settings: ListSettings<'c>,
    walker: Walker,
    gather: Gather<'m, C>,
    long: LongStrip,
    drawn: DrawCounts,
    textures: &'m [TextureSlot],
    overlays: OverlaySlots<'m>,
    matrix: Affine,
    lights: L,
    material: Material,
    point_size: u8,
    /// The window that it has asked for.
    window: Option<Window>,
    /// The texture that the material names.
    texture: Option<Bound>,
    /// What was drawn has been shown: textures that it needed are no longer.
    shown: bool,
    /// What they make of the settings' instance, but for its light.
    instance: Instance,
    /// The state has changed since: to be made anew before anything is gathered.
    stale: bool,
    counts: RunCounts,
}

impl<'m, 'c, C: ListCoordinate> ListRunner<'m, 'c, C> {
    /// Stopped; [`start`](ListRunner::start) begins. Its lists have [`OneLight`].
    #[must_use]
    pub fn new(memory: ListMemory<'m, C>, settings: ListSettings<'c>) -> Self {
        Self::with_lights(memory, settings)
    }
}

impl<'m, 'c, C: ListCoordinate, L: ListLights> ListRunner<'m, 'c, C, L> {
    /// The same with lights of a kind.
    #[must_use]
    pub fn with_lights(memory: ListMemory<'m, C>, settings: ListSettings<'c>) -> Self {
        let mut runner = Self {
            walker: Walker::new(),
            gather: Gather::new(Unpacked {
                positions: memory.positions,
                normals: memory.normals,
                colours: memory.colours,
                indices: memory.indices,
                places: memory.places,
            }),
            long: LongStrip::default(),
            drawn: DrawCounts::default(),
            textures: memory.textures,
            overlays: OverlaySlots(memory.overlays),
            matrix: Affine::IDENTITY,
            lights: L::default(),
            material: Material::default(),
            point_size: 1,
            window: None,
            texture: None,
            shown: false,
            instance: settings.instance,
            stale: true,
            settings,
            counts: RunCounts::default(),
        };
        runner.reset();
        runner
    }

    /// Begins at word `at`, with the state that the settings give.
    pub fn start(&mut self, at: u32) {
        self.command(ListCommand::Start(at));
    }

    /// Obeys a command at once.
    pub fn command(&mut self, command: ListCommand) {
        self.walker.command(command);
        if matches!(command, ListCommand::Start(_) | ListCommand::Restart) {
            self.reset();
        }
    }

    /// Other settings, from the next start on; where the list stands in the world at once.
    pub fn set_instance(&mut self, instance: Instance) {
        self.settings.instance = instance;
        self.stale = true;
    }

    /// Position of the next block; what lies before it in a ring may be freed.
    #[must_use]
    pub fn position(&self) -> u32 {
        self.walker.position()
    }

    /// What was done since the start.
    #[must_use]
    pub fn counts(&self) -> RunCounts {
        let drawn = self.drawn;
        RunCounts {
            draws: drawn.draws,
            vertices: drawn.vertices,
            triangles: drawn.triangles,
            dropped: drawn.dropped,
            ..self.counts
        }
    }

    fn reset(&mut self) {
        self.gather.reset();
        self.drawn = DrawCounts::default();
        self.counts = RunCounts::default();
        self.matrix = Affine::IDENTITY;
        self.lights.begin(self.settings.instance.light);
        let [r, g, b] = self.settings.instance.colour;
        self.material = Material {
            diffuse: [r, g, b],
            two_sided: self.settings.instance.cull == Cull::None,
            ..Material::default()
        };
        self.point_size = 1;
        (self.texture, self.shown, self.window) = (None, false, None);
        TextureSlots(self.textures).clear();
        self.overlays.clear();
        self.stale = true;
    }

    /// The instance and the texture that the state makes.
    fn renew<P: Pipeline>(&mut self, events: &mut impl EventSink) {
        self.stale = false;
        if P::Shading::TEXTURED {
            let slots = TextureSlots(self.textures);
            let bound = self.material.texture.map(|number| slots.bind(number));
            self.texture = match bound {
                Some(Ok(bound)) => Some(bound),
                None => None,
                Some(Err(NoTexture::Missing | NoTexture::Palette)) => {
                    self.unimplemented(events);
                    None
                }
                Some(Err(NoTexture::Full)) => {
                    self.notice(events, Event::Full, 0);
                    None
                }
            };
        }
        self.instance = Instance {
            model: self.matrix.then(&self.settings.instance.model),
            cull: if self.material.two_sided {
                Cull::None
            } else {
                Cull::Back
            },
            light: None,
            colour: self.material.diffuse,
        };
    }

    /// Executes the list until it halts. The scene must have been begun.
    ///
    /// What an error stops at is named; what stands before it is drawn.
    ///
    /// Where pipelines cut to windows, what it draws is cut to the window it asked for, or else to the
    /// one that it was granted.
    ///
    /// # Errors
    /// When a block is malformed. The list has stopped; a start begins it again.
    #[inline]
    pub fn run<'w, P: Pipeline>(
        &mut self,
        words: impl Words<'w>,
        scene: &mut Scene<'_, P>,
        budget: &mut Budget,
        events: &mut impl EventSink,
    ) -> Result<Halt, ListError> {
        let clip = scene.clip();
        if MarkOf::<P>::CUTS {
            let window = self.window.or(self.settings.window);
            scene.cut_to(window.map_or(clip, Clip::Inside));
        }
        let done = self.run_blocks(words, scene, budget, events);
        if MarkOf::<P>::CUTS {
            scene.cut_to(clip);
        }
        done
    }

    /// The same, cut as the scene says.
    fn run_blocks<'w, P: Pipeline>(
        &mut self,
        words: impl Words<'w>,
        scene: &mut Scene<'_, P>,
        budget: &mut Budget,
        events: &mut impl EventSink,
    ) -> Result<Halt, ListError> {
        if core::mem::take(&mut self.shown) {
            TextureSlots(self.textures).release();
            self.overlays.clear();
            self.stale = true;
        }
        loop {
            if let Some(command) = self.settings.control.and_then(ListControl::take) {
                if matches!(command, ListCommand::Start(_) | ListCommand::Restart) {
                    self.flush(words, scene, events);
                }
                self.command(command);
            }
            let step = match self.walker.step(words, budget) {
                Ok(Step::Do(instruction)) => self.execute(words, instruction, scene, events),
                other => other,
            };
            match step {
                Ok(Step::Do(_) | Step::Passed) => {}
                Ok(Step::Interrupt(vector)) => {
                    self.notice(events, Event::Interrupt, u32::from(vector));
                }
                Ok(Step::Later) => self.unimplemented(events),
                Ok(Step::Violation) => {
                    self.counts.violations += 1;
                    self.notice(events, Event::AccessViolation, 0);
                    if self.settings.on_violation == OnViolation::Stop {
                        self.walker.stop();
                        self.flush(words, scene, events);
                        return Ok(Halt::Violation);
                    }
                }
                Ok(Step::Halt(halt)) => {
                    self.flush(words, scene, events);
                    self.shown = halt == Halt::Sync;
                    if let Some(event) = self.walker.event_of(halt, words) {
                        self.notice(events, event, 0);
                    }
                    return Ok(halt);
                }
                Err(error) => {
                    self.flush(words, scene, events);
                    self.notice(events, Event::Malformed, 0);
                    return Err(error);
                }
            }
        }
    }

    #[cold]
    fn notice(&self, events: &mut impl EventSink, event: Event, value: u32) {
        events.notice(Notice {
            event,
            offset: self.walker.offset(),
            value,
        });
    }

    #[cold]
    fn unimplemented(&mut self, events: &mut impl EventSink) {
        self.counts.unimplemented += 1;
        self.notice(events, Event::Unimplemented, 0);
    }

    fn flush<'w, P: Pipeline>(
        &mut self,
        words: impl Words<'w>,
        scene: &mut Scene<'_, P>,
        events: &mut impl EventSink,
    ) {
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
        self.gather.flush(words, &mut out);
    }
}

impl FrameStats {
    /// The events of a frame that was drawn (H14). Those of pixels need a pipeline that counts.
    #[must_use]
    pub fn events(&self) -> EventSet {
        let spans = &self.spans;
        let seen = [
            (Event::PixelRendered, spans.pixels_shaded > 0),
            (
                Event::Clipped,
                self.pass_one.clipped + self.pass_one.outside_window > 0,
            ),
            (
                Event::DepthPassed,
                spans.depth_tests > 0 && spans.pixels_shaded > 0,
            ),
            (Event::DepthFailed, spans.pixels_hidden > 0),
            (Event::Full, self.pass_one.dropped > 0),
            (Event::Untextured, self.pass_one.untextured > 0),
        ];
        let mut set = EventSet::NONE;
        for (event, _) in seen.into_iter().filter(|(_, seen)| *seen) {
            set = set.with(event);
        }
        set
    }
}
