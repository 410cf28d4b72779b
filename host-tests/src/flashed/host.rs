//! The words of a scene drawn on this machine, and what memory they need.

use super::blocks::Blocks;
use super::memory::{DRAW_BYTES, VOLUME_BYTES, list_bytes, slow_bytes};
use super::tally::{Built, Listed, Meshes, PassOne, Tally, WORDS};
use super::too_large;
use crate::draw::twice;
use crate::lists::heard::{self, Heard};
use crate::rooms::{self, LineRooms, SceneRooms};
use scanbeam::input::{LightRoom, Player, PlayerMemory, RunCounts, TextureRoom};
use scanbeam::light::{DirectionalLight, Lighting, PixelLamps};
use scanbeam::list::{Lent, ListCommand, Reason, TextureSlot};
use scanbeam::look::Look;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::{CacheWord, DrawError, ShadowEdge, Texture};
use scanbeam::{Camera, Link, Scene, Screen};
use scene_flash::{
    CACHED, Call, CallError, CallMemory, Calls, Counts, FlashError, Head, Kind, Level, LightMemory,
    Lights, List, Palette, PlayError, Room, Sheet, TextureMemory, VolumeMemory,
};
use scenes::{IndexedLook, PhongLook, SmoothLook, TexturedLook, TexturedPhongLook};
use std::error::Error;

/// The first address behind the slow memory of the boards: see `memory.x`.
pub(super) const SLOW_END: u64 = 0x2200_0000;
/// Bytes of it.
const SLOW_BYTES: usize = 16 << 20;
/// What a scene can hold, whatever it is lent.
const MOST: Room = Room {
    vertices: 1 << 16,
    objects: Link::CACHED as u32,
    draws: 1 << 16,
};

/// A frame as this machine draws it.
#[derive(Debug)]
pub struct Shown {
    /// What is drawn, and how.
    pub head: Head,
    /// Words of the panel.
    pub pixels: Vec<u16>,
    /// Draw calls.
    pub calls: u32,
    /// What its player did, where it is a list.
    pub listed: Option<Listed>,
    /// What its player told that is unusual.
    pub heard: Heard,
    /// Triangles that were submitted; those that were filed are in the head's room.
    pub triangles: u32,
    /// Bytes of slow memory that it takes, here, where pointers are wider than on the boards.
    pub slow_bytes: usize,
    /// What it does with each number of slots that was asked for.
    pub tallies: Vec<Tally>,
}

impl Shown {
    /// The checksum that the firmware has of the same bytes.
    pub fn crc(&self) -> u32 {
        let bytes: Vec<u8> = self.pixels.iter().flat_map(|w| w.to_le_bytes()).collect();
        crc32fast::hash(&bytes)
    }
}

/// Why a frame was not drawn.
#[derive(Debug, thiserror::Error)]
pub enum Refused {
    /// The scene had no room.
    #[error("{0}: boards draw a picture as one scene, which holds no more")]
    Full(String),
    /// The player had none.
    #[error("{0}")]
    Lent(Lent, String),
    /// Anything else.
    #[error("{0}")]
    Other(String),
}

fn other(error: impl std::fmt::Display) -> Refused {
    Refused::Other(error.to_string())
}

impl From<FlashError> for Refused {
    fn from(error: FlashError) -> Self {
        other(error)
    }
}

impl From<PlayError> for Refused {
    fn from(error: PlayError) -> Self {
        match error {
            PlayError::Begin(error) => other(error),
            PlayError::List(error) => match error.reason {
                Reason::Lent(lent) => Self::Lent(lent, error.to_string()),
                _ => other(error),
            },
            PlayError::Halted(halt, at) => {
                let at = 4 * u64::from(at);
                Self::Other(format!(
                    "halted at offset {at:#x}, before its end: {halt:?}"
                ))
            }
            PlayError::Full(count) => Self::Full(format!("{count} triangles find no room")),
        }
    }
}

/// Draws a scene with as much memory as there can be, then with as little as it takes, which is written into its words.
/// `objects` are those of the file that the draw calls are of, by their numbers.
///
/// # Errors
/// When it cannot be drawn, or not whole.
pub fn settle(words: &mut [u32], objects: &[usize]) -> Result<Shown, Box<dyn Error>> {
    let first = loop {
        match frame(words, objects, MOST) {
            Err(Refused::Lent(lent, why)) => grow(words, lent, why)?,
            drawn => break drawn?,
        }
    };
    // At no time does it take more than in the end: vertices that find no room are those of meshes that are not kept.
    first.head.write(words);
    let drawn = frame(words, objects, first.head.room)?;
    Ok(Shown {
        head: first.head,
        ..drawn
    })
}

/// Lends the player of a list twice as much of what it had too little of.
pub fn grow(words: &mut [u32], lent: Lent, why: String) -> Result<(), Box<dyn Error>> {
    let (head, mut reader) = Head::read(words)?;
    let list = List::read(&mut reader)?;
    let mut room = list.room;
    let slot = match lent {
        Lent::Vertices | Lent::Places => &mut room.table,
        Lent::Indices => &mut room.indices,
        Lent::Names => &mut room.names,
        Lent::Textures => &mut room.textures,
        Lent::Texels => &mut room.texels,
        Lent::Levels => &mut room.levels,
        Lent::Overlays => return Err("overlays, which boards do not draw".into()),
        _ => return Err(why.into()),
    };
    *slot = slot.saturating_mul(2).max(4);
    let needed = slow_bytes(&head, DRAW_BYTES) + list_bytes(&room);
    if needed > SLOW_BYTES {
        return Err(too_large(needed as u64, SLOW_BYTES as u64).into());
    }
    let room = List { room, ..list }.to_words();
    words[Head::WORDS..Head::WORDS + room.len()].copy_from_slice(&room);
    Ok(())
}

/// Draws a frame in so much memory.
pub fn frame(words: &[u32], objects: &[usize], room: Room) -> Result<Shown, Refused> {
    surveyed(words, objects, room, &[])
}

/// The same, and what it does with each of these numbers of slots, at most [`MOST_SLOTS`](crate::draw::MOST_SLOTS).
pub fn surveyed(
    words: &[u32],
    objects: &[usize],
    room: Room,
    slots: &[u16],
) -> Result<Shown, Refused> {
    let (head, mut reader) = Head::read(words)?;
    let lend = Lend { room, slots };
    if matches!(head.kind, Kind::ListSmooth | Kind::ListTextured) {
        let list = List::read(&mut reader)?;
        return match head.kind {
            Kind::ListTextured => played::<TexturedLook>(&head, &list, lend),
            _ => played::<SmoothLook>(&head, &list, lend),
        };
    }
    let counts = Counts::read(&mut reader)?;
    let mut lent = Owned::new(&counts);
    let (camera, screen) = (head.camera().map_err(other)?, screen(&head)?);
    let calls = Calls::read::<Rgb565Be>(&mut reader, lent.lend(), &camera, screen)?;
    let called = Called {
        head,
        calls,
        counts,
        objects,
    };
    match head.kind {
        Kind::Textured => called.coloured::<TexturedLook>(lend),
        Kind::TexturedPhong => called.coloured::<TexturedPhongLook>(lend),
        Kind::Phong => called.coloured::<PhongLook>(lend),
        Kind::Indexed => {
            let (shown, indices) = called.draw::<IndexedLook>(lend, 0)?;
            let lines = (0..).zip(indices.chunks(head.size[0].into()));
            let colour = |(line, row): (u16, &[u8])| {
                let palette = calls.palette(line);
                let of = |index: &u8| palette.get(usize::from(*index)).copied();
                row.iter().filter_map(of).collect::<Vec<u16>>()
            };
            let pixels = lines.flat_map(colour).collect();
            Ok(Shown { pixels, ..shown })
        }
        Kind::Smooth | Kind::ListSmooth | Kind::ListTextured => called.coloured::<SmoothLook>(lend),
    }
}

/// What a scene is lent, and the numbers of slots with which it is counted.
#[derive(Clone, Copy)]
struct Lend<'a> {
    room: Room,
    slots: &'a [u16],
}

/// What calls are read into.
struct Owned<'t> {
    lights: Vec<DirectionalLight>,
    lightings: Vec<Option<Lighting<'t>>>,
    lamps: Vec<Option<PixelLamps>>,
    sheets: Vec<Sheet<'t>>,
    levels: Vec<Level<'t>>,
    textures: Vec<Texture<'t>>,
    others: Vec<Texture<'t>>,
    cached: Vec<CacheWord>,
    palettes: Vec<Palette<'t>>,
    calls: Vec<Call<'t>>,
}

impl<'t> Owned<'t> {
    fn new(counts: &Counts) -> Self {
        let (lights, textures) = (counts.lights, counts.textures);
        let many = |count: u32| 0..count;
        Self {
            lights: vec![Lights::DARK; lights.lights as usize],
            lightings: many(lights.lightings).map(|_| None).collect(),
            lamps: many(lights.lamps).map(|_| None).collect(),
            sheets: vec![Sheet::EMPTY; textures.textures as usize],
            levels: many(textures.levels).map(|_| Level::EMPTY).collect(),
            textures: vec![Texture::EMPTY; textures.textures as usize],
            others: vec![Texture::EMPTY; textures.others as usize],
            cached: (0..CACHED * textures.caches as usize)
                .map(|_| CacheWord::new())
                .collect(),
            palettes: vec![(0, &[][..]); counts.palettes as usize],
            calls: vec![Calls::EMPTY; counts.calls as usize],
        }
    }

    fn lend(&'t mut self) -> CallMemory<'t> {
        CallMemory {
            lights: LightMemory {
                lights: &mut self.lights,
                lightings: &mut self.lightings,
                lamps: &mut self.lamps,
            },
            textures: TextureMemory {
                sheets: &mut self.sheets,
                levels: &mut self.levels,
                textures: &mut self.textures,
                others: &mut self.others,
                cached: &mut self.cached,
            },
            palettes: &mut self.palettes,
            calls: &mut self.calls,
        }
    }
}

/// A picture, and the words of its pixels.
type Drawn<L> = (Shown, Vec<<<L as Look>::Pixel as PixelFormat>::Word>);
/// A word of a look's pixels.
type Word<L> = <<L as Look>::Pixel as PixelFormat>::Word;

/// Draw calls, and what they are of.
struct Called<'o, 't> {
    head: Head,
    calls: Calls<'t>,
    counts: Counts,
    objects: &'o [usize],
}

impl<'t> Called<'_, 't> {
    /// Draws colours.
    fn coloured<L: Look<Pixel = Rgb565Be>>(&self, lend: Lend<'_>) -> Result<Shown, Refused> {
        let background = Rgb565Be::from_rgb8(self.head.background);
        let (shown, pixels) = self.draw::<L>(lend, background)?;
        let pixels = match self.head.doubled {
            true => {
                twice::<Rgb565Be>(&pixels, self.head.size[0])
                    .map_err(other)?
                    .words
            }
            false => pixels,
        };
        Ok(Shown { pixels, ..shown })
    }

    /// What all meshes have.
    fn meshes(&self) -> Meshes {
        let mut all = Meshes {
            lights: self.counts.lights.lights,
            ..Meshes::default()
        };
        for call in self.calls.calls {
            let (Call::Mesh(draw) | Call::Said(_, draw)) = call else {
                continue;
            };
            let vertices = draw.mesh.positions.len() as u32;
            all.vertices += vertices;
            all.lit += if draw.lights.is_some() { vertices } else { 0 };
            all.placed += if draw.texture.is_some() { vertices } else { 0 };
        }
        all
    }

    /// Draws them over a background.
    fn draw<L: Look>(&self, lend: Lend<'_>, background: Word<L>) -> Result<Drawn<L>, Refused> {
        let thrown = self.counts.thrown as usize;
        let mut memory = VolumeMemory {
            edges: &mut vec![ShadowEdge::default(); 3 * thrown],
            positions: &mut vec![[0; 3]; 6 * thrown],
            faces: &mut vec![[0; 3]; 6 * thrown],
        };
        let has_shadows = self.counts.volumes > 0;
        let drawn = drawn::<L>(
            &self.head,
            lend,
            (background, has_shadows),
            |scene, camera| {
                let drawn = self.calls.draw(camera, scene, &mut memory);
                drawn.map_err(|error| {
                    let (call, error) = match error {
                        CallError::Begin(error) => return other(error),
                        CallError::Draw(call, error) => (call, error),
                    };
                    let said = match self.objects.get(call) {
                        Some(object) => format!("object {object}: {error}"),
                        None => error.to_string(),
                    };
                    match error {
                        DrawError::Full { .. } => Refused::Full(said),
                        _ => Refused::Other(said),
                    }
                })?;
                Ok(Built {
                    draws: self.counts.states(),
                    meshes: self.meshes(),
                    listed: None,
                })
            },
        );
        let (shown, pixels) = drawn?;
        let slow_bytes = shown.slow_bytes + thrown * VOLUME_BYTES;
        Ok((
            Shown {
                slow_bytes,
                ..shown
            },
            pixels,
        ))
    }
}

/// The screen of what is drawn.
fn screen(head: &Head) -> Result<Screen, Refused> {
    let [width, height] = head.size;
    Screen::new(width, height).map_err(other)
}

/// Plays a list.
fn played<L: Look<Pixel = Rgb565Be>>(
    head: &Head,
    list: &List<'_>,
    lend: Lend<'_>,
) -> Result<Shown, Refused> {
    let [table, indices, names, textures, texels, levels] = [
        list.room.table,
        list.room.indices,
        list.room.names,
        list.room.textures,
        list.room.texels,
        list.room.levels,
    ]
    .map(|count| count as usize);
    let names: Vec<TextureSlot> = (0..names).map(|_| TextureSlot::new()).collect();
    let places = if textures > 0 { table } else { 0 };
    let mut textures: Vec<_> = (0..textures).map(|_| TextureRoom::EMPTY).collect();
    let (mut positions, mut normals) = (vec![[0; 3]; table], vec![[0; 3]; table]);
    let (mut colours, mut alphas) = (vec![[0; 3]; table], vec![0; table]);
    let (mut places, mut indices) = (vec![[0; 2]; places], vec![0; indices]);
    let (mut texels, mut levels) = (vec![0; texels], vec![Texture::EMPTY; levels]);
    let mut lights = LightRoom::new();
    let memory = PlayerMemory {
        positions: &mut positions,
        normals: &mut normals,
        colours: &mut colours,
        indices: &mut indices,
        places: &mut places,
        alphas: &mut alphas,
        names: &names,
        textures: &mut textures,
        texels: &mut texels,
        levels: &mut levels,
        overlays: &[],
        lights: Some(&mut lights),
    };
    let mut player = Player::<L>::new(memory, list.settings());
    let blocks = Blocks::of(list.words);
    let background = Rgb565Be::from_rgb8(head.background);
    let mut told = Heard::new();
    let done = drawn::<L>(head, lend, (background, false), |scene, camera| {
        let hear = |notice| heard::hear(&mut told, notice);
        let played = list.play_heard(&mut player, ListCommand::Start(0), camera, scene, hear);
        Ok(built(played.map_err(Refused::from)?, &blocks))
    });
    let (shown, pixels) = done?;
    let slow_bytes = shown.slow_bytes + list_bytes(&list.room);
    heard::keep_unusual(&mut told);
    Ok(Shown {
        pixels,
        heard: told,
        slow_bytes,
        ..shown
    })
}

/// What a player has put into a scene from a list of such blocks.
fn built(counts: RunCounts, blocks: &Blocks) -> Built {
    let is_each_once = counts.vertices == blocks.meshes.vertices;
    let several = (!is_each_once).then_some("tables that are drawn several times, or not at all");
    Built {
        draws: counts.draws.max(1),
        meshes: Meshes {
            vertices: counts.vertices,
            ..blocks.meshes
        },
        listed: Some(Listed {
            blocks: counts.blocks,
            triangles: counts.triangles,
            white: blocks.white,
            beyond: blocks.beyond.or(several),
        }),
    }
}

/// Draws what `build` makes over a background, with shadows or without.
fn drawn<'t, L: Look>(
    head: &Head,
    Lend { room, slots }: Lend<'_>,
    (background, has_shadows): (Word<L>, bool),
    build: impl FnOnce(&mut Scene<'_, 't, L>, &Camera) -> Result<Built, Refused>,
) -> Result<Drawn<L>, Refused> {
    let [width, height] = head.size;
    let screen = screen(head)?;
    let camera = head.camera().map_err(other)?;
    let vertices = room.vertices as usize;
    let lent = rooms::Room {
        vertices,
        places: if head.kind.is_textured() { vertices } else { 0 },
        objects: room.objects as usize,
        draws: room.draws as usize,
    };
    let mut memory = SceneRooms::new(lent, height);
    let mut scene = memory.scene::<L>(screen);
    let built = build(&mut scene, &camera)?;
    let draws = built.draws;
    let mut lines = LineRooms::<L, WORDS>::new(scene.objects(), width);
    if has_shadows {
        lines = lines.with_counts();
    }
    let mut renderer = lines.renderer();
    let mut pixels = Vec::new();
    let mut line = vec![background; width.into()];
    for y in scene.lines() {
        let drawn = renderer.draw_line(&scene, y, &mut line, background);
        drawn.map_err(other)?;
        pixels.extend_from_slice(&line);
    }
    let head = Head {
        room: Room {
            vertices: scene.vertices() as u32,
            objects: scene.objects() as u32,
            draws,
        },
        ..*head
    };
    let pass_one = PassOne::of(&scene, built);
    let tallies = Tally::count_all(&scene, pass_one, slots, background);
    let shown = Shown {
        tallies: tallies.map_err(other)?,
        head,
        pixels: Vec::new(),
        calls: draws,
        listed: built.listed,
        heard: Heard::new(),
        triangles: scene.assembled().triangles,
        slow_bytes: slow_bytes(&Head { room, ..head }, DRAW_BYTES),
    };
    Ok((shown, pixels))
}
