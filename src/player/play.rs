//! The player: it walks a list, and halts where that says so (H12, H13, X7).

use super::gather::Gather;
use super::lights;
use super::shadows::{Casts, cast};
use super::state::State;
use super::textures::Shelf;
use super::{LightRoom, OnViolation, RunCounts, TextureRoom};
use crate::event::{Event, Notice};
use crate::geometry::{Coordinate, Mesh, Screen, ShadowLight, ShadowMemory};
use crate::list::{
    Halt, Lent, ListCommand, ListControl, ListError, Missing, OverlaySlot, OverlaySlots, Place,
    Reason, Step, TextureSlot, TextureSlots, Walker, Window, Words,
};
use crate::look::Look;
use crate::scene::{Budget, Draw, Sampling, Scene, Shadow, Texture};

/// Memory of a player, lent by the application.
///
/// Vertices are unpacked into the first three: as many at once as the shortest of those that a block needs has. 4 are
/// the least; what a list's largest table needs is in its HEAD. Columns of a table that have a mesh's own form are
/// used where they lie, and need none.
///
/// `C` is the coordinate type of the meshes that are drawn: `i16`, or `i32` for lists that have places of 32 bits.
#[derive(Default)]
pub struct PlayerMemory<'m, 't, C = i16> {
    /// Places, 6 bytes each, or 12.
    pub positions: &'m mut [[C; 3]],
    /// Normals, 6 bytes each.
    pub normals: &'m mut [[i16; 3]],
    /// Colours, 3 bytes each.
    pub colours: &'m mut [[u8; 3]],
    /// Indices of faces that are drawn together, at least 4; 3 a triangle. Each time they are
    /// full, the vertices of a table are transformed once more.
    pub indices: &'m mut [u16],
    /// Texture places, 8 bytes each, as many as positions; none where nothing is textured.
    pub places: &'m mut [[i32; 2]],
    /// Alphas of vertices whose colours are 4x8U, one byte each, as many as positions; none, and alphas of vertices are
    /// passed over.
    pub alphas: &'m mut [u8],
    /// One for each number of a texture and of a palette; none where nothing is textured.
    pub names: &'m [TextureSlot],
    /// One for each pair of a texture and a palette that is drawn with, and each [`sampling`](PlayerSettings::sampling) of
    /// it; two where texels are neither opaque nor transparent, or some are not dithered where the rest is.
    pub textures: &'t mut [TextureRoom<'t>],
    /// Words of the panel: 2, 4, 16 or 256 for a palette of 1, 2, 4 or 8 bits, 256 for one of 6 bits, and one a texel
    /// of other forms, but for those of 16 bits in the panel's order of bytes. Twice as many where there are two
    /// textures of a pair.
    pub texels: &'t mut [u16],
    /// Levels of detail below the first: up to 3 for each texture that has several, likewise.
    pub levels: &'t mut [Texture<'t>],
    /// One for each overlay of a frame; none where there are none. The
    /// [`ListOverlays`](crate::overlay::ListOverlays) that paint them have the same ones, and the names above have those
    /// of their palettes.
    pub overlays: &'m [OverlaySlot],
    /// Where lists may have coloured lights, several, and highlights: room for them.
    pub lights: Option<&'m mut LightRoom>,
}

/// What a list starts from, and what it may do.
#[derive(Clone, Copy, Debug)]
pub struct PlayerSettings<'m, 't> {
    /// How the list begins: `model` takes its world to the application's; `cull`, `colour` and the lights are those
    /// until the list says otherwise; its mesh and its texture are not looked at, and the rest stays.
    pub draw: Draw<'m, 't>,
    /// Whether its cameras count; else they are access violations.
    pub camera: bool,
    /// The part of the picture that it may ask for as its window, to which it is cut; `None`: all.
    pub window: Option<Window>,
    /// How far texels may be from their places where a block has PRSP; elsewhere [`Budget::FAST`].
    pub budget: Budget,
    /// How texels of the list are taken; `None`: the nearest one.
    pub sampling: Option<Sampling>,
    /// What materials mean by the number 0, 1 and so on, whatever the list has by that number; `None`, and beyond the
    /// last: the list's. These may be [computed](Texture::computed) (H17), or lie in blocks behind a
    /// [cache](crate::scene::BlockCache) (B1, B5); they keep their wrap and the way in which their texels are taken, and
    /// one that has a mask is blended by its alphas.
    pub textures: &'m [Option<&'t Texture<'t>>],
    /// The lights whose shadows what is drawn casts, for players [`with_shadows`](Player::with_shadows) alone; what has a
    /// [`shadow`](Draw::shadow) itself casts none.
    pub casts: &'m [ShadowLight],
    /// After an access violation.
    pub on_violation: OnViolation,
    /// Where commands come from, beside [`Player::command`].
    pub control: Option<&'m ListControl>,
}

impl<'m> PlayerSettings<'m, '_> {
    /// The lights whose shadows what is drawn casts.
    pub(super) fn casting(&self) -> &'m [ShadowLight] {
        match self.draw.shadow {
            None => self.casts,
            Some(_) => &[],
        }
    }
}

impl Default for PlayerSettings<'_, '_> {
    /// White, not lit, faces from behind dropped, no camera of its own.
    fn default() -> Self {
        Self {
            draw: Draw::new(Mesh::EMPTY),
            camera: false,
            window: None,
            budget: Budget::BALANCED,
            sampling: None,
            textures: &[],
            casts: &[],
            on_violation: OnViolation::GoOn,
            control: None,
        }
    }
}

/// Plays lists into scenes of a look.
///
/// It walks a [`list`](crate::list) block by block. Blocks of state change one [`Draw`](crate::scene::Draw)
/// value; what blocks of vertices hold is drawn with it, so a list gives the same bits as the same calls.
///
/// | of a list | in a draw call |
/// |---|---|
/// | MATRIX | `model`: the list's, then that of the settings |
/// | LIGHT 0, white, alone on what is matt | `light` |
/// | LIGHT 0 to 7, highlights, where memory has a [`LightRoom`](super::LightRoom) | `lights` |
/// | MATERIAL | `colour`, `cull`, `blend` of its opacity; not lit: no light |
/// | TEXTURE, PALETTE | `texture`: texels where they lie, a palette as the panel has it; what has alpha 0 is transparent; filtered if the settings say so; or one of the [settings](PlayerSettings::textures) |
/// | alphas of vertices, where memory has [room](PlayerMemory::alphas) for them | `alphas`; where one is below 255, a `blend` by them |
/// | texels of other alphas, and of the D bit | a [mask](crate::scene::Texture::masked); with alphas, a `blend` by them |
/// | PRSP | the budget of the settings for texture places, else 1/2 texel |
/// | WINDOW | `scissor` |
/// | POINTS, LONG | [`Scene::draw_points`], [`Scene::draw_screen`] |
/// | OVERLAY | none: [`ListOverlays`](crate::overlay::ListOverlays) over the lines |
/// | all that is opaque and lit, for players [`with_shadows`](Player::with_shadows) | volumes of its own faces, by [`Scene::draw_shadow`] |
/// | nothing | `shading`, `depth`, `dither`, `priority`, `application`, `lamps`, `shadow`: those of the settings |
///
/// **What a player does not have is refused, never left out**: [`Reason::Missing`](crate::list::Reason::Missing) says
/// what, and where. These are places of 32 bits where `C` is `i16`, coloured or several lights and highlights without memory for them, shadows by priority or of points, and what the look of the scene cannot have: textures, lamps, blends of numbers of a palette. A list
/// that is started is walked once without drawing, as far as the budget reaches, before any of it is drawn: what is malformed, missing or too large for the memory is an error then, and the scene
/// is as it was. [`ListCommand::Restart`](crate::list::ListCommand) plays the same list again without that walk.
///
/// ```
/// use scanbeam::event::Notice;
/// use scanbeam::list::{Budget, words_of};
/// use scanbeam::look::Look;
/// use scanbeam::input::{Player, PlayerMemory, PlayerSettings};
/// use scanbeam::scene::Scene;
///
/// /// `bytes` come from `include_list!("teapot.list")`; the memory is for one table of the list.
/// fn draw<'t, L: Look>(
///     scene: &mut Scene<'_, 't, L>,
///     bytes: &'t [u8],
/// ) -> Result<(), Box<dyn std::error::Error>> {
///     let memory = PlayerMemory {
///         positions: &mut [[0i16; 3]; 255],
///         normals: &mut [[0; 3]; 255],
///         indices: &mut [0; 1536],
///         ..PlayerMemory::default()
///     };
///     let mut player = Player::new(memory, PlayerSettings::default());
///     player.start(0);
///     // An error says which block is malformed, or asks for what there is not, and where.
///     let mut budget = Budget::of(10_000);
///     player.run(words_of(bytes)?, scene, &mut budget, &mut |notice: Notice| println!("{notice:?}"))?;
///     Ok(())
/// }
/// ```
pub struct Player<'m, 't, L, C = i16> {
    pub(super) settings: PlayerSettings<'m, 't>,
    pub(super) walker: Walker,
    pub(super) gather: Gather<'m, C>,
    pub(super) names: TextureSlots<'m>,
    pub(super) overlays: OverlaySlots<'m>,
    /// What was drawn has been shown: its overlays are no longer.
    is_shown: bool,
    pub(super) shelf: Shelf<'t>,
    pub(super) state: State<'m, 't>,
    pub(super) lights: Option<&'m mut LightRoom>,
    pub(super) casts: Option<Casts<'m, 't, L, C>>,
    /// The list that begins is to be looked at before it is drawn.
    unchecked: bool,
    pub(super) counts: RunCounts,
}

/// A player at work on a list.
pub(super) struct Stage<'s, 'n, 'm, 't, L, C, W> {
    pub(super) player: &'s mut Player<'m, 't, L, C>,
    pub(super) words: W,
    /// None where blocks are only looked at.
    pub(super) scene: Option<&'s mut Scene<'n, 't, L>>,
    pub(super) screen: Screen,
    pub(super) events: &'s mut dyn FnMut(Notice),
}

impl<'m, 't, L: Look, C: Coordinate + Place> Player<'m, 't, L, C> {
    /// Stopped; [`start`](Player::start) begins.
    #[must_use]
    pub fn new(memory: PlayerMemory<'m, 't, C>, settings: PlayerSettings<'m, 't>) -> Self {
        let mut gather = Gather::default();
        gather.positions = memory.positions;
        gather.normals = memory.normals;
        gather.colours = memory.colours;
        gather.indices = memory.indices;
        gather.places = memory.places;
        gather.alphas = memory.alphas;
        Self {
            walker: Walker::new(),
            gather,
            names: TextureSlots(memory.names),
            overlays: OverlaySlots(memory.overlays),
            is_shown: false,
            shelf: Shelf {
                free: memory.textures,
                last: None,
                words: memory.texels,
                levels: memory.levels,
            },
            state: State::new(&settings),
            lights: memory.lights,
            casts: None,
            settings,
            unchecked: false,
            counts: RunCounts::default(),
        }
    }

    /// The same, with shadows of the lights that its [settings](PlayerSettings::casts) name (K9), by memory for one volume
    /// at a time. What is in them is drawn by the same list once more, with settings that have a [`shadow`](Draw::shadow).
    ///
    /// What is lit and opaque casts its shadow as it is drawn, as many faces at once as
    /// [`indices`](PlayerMemory::indices) has room for; points and triangles on the screen cast none. Best are closed
    /// meshes that have room as a whole: where one is parted, both parts have a volume at their border, which cancel each
    /// other but for some pixels along it. Nothing is passed over that is out of sight or turned away.
    #[must_use]
    pub fn with_shadows(self, memory: ShadowMemory<'m>) -> Self {
        let casts = Some(Casts { memory, cast });
        Self { casts, ..self }
    }

    /// Begins at word `at`, with the state that the settings give.
    pub fn start(&mut self, at: u32) {
        self.command(ListCommand::Start(at));
    }

    /// Obeys a command at once. A list that is started is looked at as a whole before it is drawn;
    /// [`Restart`](ListCommand::Restart) takes it to be as it was then.
    pub fn command(&mut self, command: ListCommand) {
        self.walker.command(command);
        match command {
            ListCommand::Start(_) => self.unchecked = true,
            ListCommand::Restart => {}
            _ => return,
        }
        self.reset();
    }

    /// Other settings. They count from the next block on, with two exceptions. What [`draw`](PlayerSettings::draw) has
    /// beside its model counts from the next start on. A [`window`](PlayerSettings::window) bounds what WINDOW asks for at
    /// once, and cuts from the next WINDOW or start on. Textures that were made in another way are made anew, in memory of
    /// their own.
    pub fn set(&mut self, settings: PlayerSettings<'m, 't>) {
        self.settings = settings;
        self.state.place(self.state.matrix, &self.settings);
        self.state.is_stale = true;
    }

    /// Position of the next block; what lies before it in a ring may be freed. [`Lent::Places`] says what a table must stay
    /// for.
    #[must_use]
    pub fn position(&self) -> u32 {
        self.walker.position()
    }

    /// What was done since the start.
    #[must_use]
    pub fn counts(&self) -> RunCounts {
        self.counts
    }

    fn reset(&mut self) {
        self.gather.reset();
        self.counts = RunCounts::default();
        self.state = State::new(&self.settings);
        self.names.clear();
        self.overlays.clear();
        self.is_shown = false;
        lights::begin(self.lights.as_deref_mut(), self.settings.draw.light);
    }

    /// Executes the list until it halts. The scene must have been begun.
    ///
    /// A list that was started is first walked to its end, or as far as `budget` reaches, and nothing is drawn where
    /// that meets an error. What a budget, a pause or a ring kept from being looked at then is looked at block by
    /// block, each before any of it is done; what stands before it is drawn. So it is with what errs only where words are
    /// passed over by BOUNDS or CONE, which that walk never does: they end within a block, or what follows counts on them.
    ///
    /// # Errors
    /// When a block is malformed, or asks for what there is not. The list has stopped; a start begins it again, and
    /// [`ListCommand::Resume`] goes on behind a block that asked for what there is not.
    pub fn run(
        &mut self,
        words: impl Words<'t>,
        scene: &mut Scene<'_, 't, L>,
        budget: &mut crate::list::Budget,
        events: &mut dyn FnMut(Notice),
    ) -> Result<Halt, ListError> {
        let screen = scene.screen();
        if scene.camera.is_none() {
            return Err(self.unfit(Reason::NotBegun));
        }
        // The scene may have been begun anew.
        self.state.eye = None;
        let mut stage = Stage {
            player: self,
            words,
            scene: Some(scene),
            screen,
            events,
        };
        if stage.player.walker.is_running() {
            let ready = stage.player.ready();
            ready.map_err(|error| stage.malformed(error))?;
        }
        loop {
            let player = &mut *stage.player;
            if let Some(command) = player.settings.control.and_then(ListControl::take) {
                if matches!(command, ListCommand::Start(_) | ListCommand::Restart) {
                    let drawn = stage.flush();
                    drawn.map_err(|error| stage.malformed(error))?;
                }
                stage.player.command(command);
            }
            let player = &mut *stage.player;
            if player.unchecked && player.walker.is_running() {
                let checked = player.check(words, screen, *budget);
                checked.map_err(|error| stage.malformed(error))?;
            }
            match stage.step(budget) {
                Ok(None) => {}
                Ok(Some(halt)) => return Ok(halt),
                Err(error) => {
                    // What stands before it was drawn already, or is now.
                    let _ = stage.flush();
                    return Err(stage.malformed(error));
                }
            }
        }
    }

    /// Walks the list from where it is to begin, without drawing, to its end or as far as the budget reaches; pauses
    /// and syncs are passed over. Then it is where it was, and all state is that of the start.
    ///
    /// # Errors
    /// When a block is malformed, or asks for what there is not. The list has stopped.
    pub fn check(
        &mut self,
        words: impl Words<'t>,
        screen: Screen,
        mut budget: crate::list::Budget,
    ) -> Result<Halt, ListError> {
        self.ready()?;
        let begin = self.walker.clone();
        self.walker.command(ListCommand::Start(begin.position()));
        self.reset();
        let mut stage = Stage {
            player: self,
            words,
            scene: None,
            screen,
            events: &mut |_: Notice| {},
        };
        let done = loop {
            match stage.step(&mut budget) {
                Ok(None | Some(Halt::Sync)) => {}
                Ok(Some(Halt::Paused)) => stage.player.walker.command(ListCommand::Resume),
                Ok(Some(halt)) => break Ok(halt),
                Err(error) => break Err(error),
            }
        };
        if done.is_ok() {
            self.walker = begin;
            self.unchecked = false;
        }
        self.reset();
        done
    }

    /// Whether what the settings ask for can be had.
    fn fits(&self) -> Result<(), Reason> {
        let draw = &self.settings.draw;
        let at_vertices = draw.light.is_some() || draw.lights.is_some();
        if draw.lamps.is_some() && at_vertices {
            return Err(Reason::Missing(Missing::LightAtVertices));
        }
        if draw.lamps.is_some() && L::LIT_AT_PIXELS.is_none() {
            return Err(Reason::Missing(Missing::Lamps));
        }
        let casts = self.settings.casting();
        if !casts.is_empty() && self.casts.is_none() {
            return Err(Reason::Lent(Lent::Shadows));
        }
        let cast = casts.iter().map(|cast| cast.light);
        let mut lights = cast.chain(draw.shadow.map(Shadow::light));
        match lights.any(|light| draw.priority > 0 || light >= Shadow::LIGHTS) {
            true => Err(Reason::Missing(Missing::Shadows)),
            false => Ok(()),
        }
    }

    fn ready(&mut self) -> Result<(), ListError> {
        self.fits().map_err(|reason| self.unfit(reason))
    }

    /// An error that no block has made.
    #[cold]
    fn unfit(&mut self, reason: Reason) -> ListError {
        self.walker.stop();
        ListError::at(self.walker.position(), None, reason)
    }
}

impl<'t, L: Look, C: Coordinate + Place, W: Words<'t>> Stage<'_, '_, '_, 't, L, C, W> {
    /// Does the next block; why the list does not go on, if it does not.
    fn step(&mut self, budget: &mut crate::list::Budget) -> Result<Option<Halt>, ListError> {
        let player = &mut *self.player;
        if core::mem::take(&mut player.is_shown) {
            player.overlays.clear();
        }
        let mut step = player.walker.step(self.words, budget)?;
        if let Step::Do(instruction) = step {
            step = self.execute(instruction)?;
        }
        let player = &mut *self.player;
        match step {
            Step::Do(_) | Step::Passed => {}
            Step::Interrupt(vector) => self.notice(Event::Interrupt, u32::from(vector)),
            Step::Later => {
                player.counts.unimplemented = player.counts.unimplemented.saturating_add(1);
                self.notice(Event::Unimplemented, 0);
            }
            Step::Violation => {
                player.counts.violations = player.counts.violations.saturating_add(1);
                self.notice(Event::AccessViolation, 0);
                if self.player.settings.on_violation == OnViolation::Stop {
                    self.player.walker.stop();
                    self.flush()?;
                    return Ok(Some(Halt::Violation));
                }
            }
            Step::Halt(halt) => {
                self.flush()?;
                self.player.is_shown = halt == Halt::Sync;
                if let Some(event) = self.player.walker.event_of(halt, self.words) {
                    self.notice(event, 0);
                }
                return Ok(Some(halt));
            }
        }
        Ok(None)
    }

    /// Tells of an error, which is handed through.
    #[cold]
    fn malformed(&mut self, error: ListError) -> ListError {
        self.notice(Event::Malformed, 0);
        error
    }

    #[cold]
    fn notice(&mut self, event: Event, value: u32) {
        (self.events)(Notice {
            event,
            offset: self.player.walker.offset(),
            value,
        });
    }
}
