//! What hostile lists, small memory and settings that change do to a player.

mod flow;
mod textures;

use super::{Player, PlayerMemory, PlayerSettings, TextureRoom};
use crate::event::{Event, Notice};
use crate::frame::{FastMemory, Memory as LineMemory, Renderer};
use crate::geometry::{Camera, Screen};
use crate::link::Link;
use crate::list::{Budget, Halt, ListError, ListRing, TextureSlot, Words};
use crate::look::Textured;
use crate::pixel::Rgb565;
use crate::scene::{DrawState, Memory, Object, Scene, Texture, TexturePlace, Vertex};
use core::sync::atomic::AtomicU32;
use std::vec;
use std::vec::Vec;

type Look = Textured<Rgb565>;

const SHADE: u32 = 0x80;
const PRSP: u32 = 0x40;
const TEXT: u32 = 0x20;
const NEW: u32 = 0x10;
const PLENTY: Budget = Budget {
    instructions: 1 << 20,
    vertices: 1 << 24,
    jumps: 1 << 16,
};
const WIDTH: u16 = 48;
const HEIGHT: u16 = 36;

/// A header of so many elements.
const fn block(id: u32, count: u32, bits: u32) -> u32 {
    id << 28 | 1 << 24 | count << 8 | bits
}

const fn state(what: u32, argument: u32) -> u32 {
    block(7, what << 8 | argument, 0)
}

const fn flow(what: u32) -> u32 {
    block(0, what << 8, 0)
}

/// The words of a list, as they lie.
fn listed(words: &[u32]) -> &'static [u32] {
    let words: Vec<u32> = words.iter().map(|w| w.to_le()).collect();
    Vec::leak(words)
}

const fn corner(x: i16, y: i16) -> [u32; 2] {
    [x as u16 as u32 | (y as u16 as u32) << 16, 0]
}

/// The corners of a square that lies in the middle, in the order of a strip.
const CORNERS: [[u32; 2]; 4] = [
    corner(-8_000, -8_000),
    corner(8_000, -8_000),
    corner(-8_000, 8_000),
    corner(8_000, 8_000),
];

/// A strip of some of these corners.
fn strip(corners: &[[u32; 2]], bits: u32) -> Vec<u32> {
    let header = block(1, corners.len() as u32, bits);
    [&[header], corners.as_flattened()].concat()
}

/// A material, which is not lit and seen from both sides.
fn material(texture: Option<u32>) -> Vec<u32> {
    let number = texture.map_or(0, |number| 4 | number << 8);
    vec![state(5, 0), 0xFFFF_FFFF, 0, number | 3]
}

/// BOUNDS of what is behind the eye, of so many words.
fn behind(words: u32) -> Vec<u32> {
    vec![state(11, 0), 0, 0, 1 << 29, 1, 8, words]
}

/// What is lent to players. It is never given back.
#[derive(Clone, Copy)]
struct Lent {
    textures: usize,
    texels: usize,
    levels: usize,
}

impl Lent {
    const SOME: Self = Self {
        textures: 8,
        texels: 1024,
        levels: 8,
    };
}

fn player(
    settings: PlayerSettings<'static, 'static>,
    lent: Lent,
) -> Player<'static, 'static, Look> {
    let rooms = (0..lent.textures).map(|_| TextureRoom::EMPTY);
    let names: Vec<TextureSlot> = (0..8).map(|_| TextureSlot::new()).collect();
    let memory = PlayerMemory {
        positions: Vec::leak(vec![[0; 3]; 64]),
        normals: Vec::leak(vec![[0; 3]; 64]),
        colours: Vec::leak(vec![[0; 3]; 64]),
        indices: Vec::leak(vec![0; 96]),
        places: Vec::leak(vec![[0; 2]; 64]),
        names: Vec::leak(names),
        textures: Vec::leak(rooms.collect()),
        texels: Vec::leak(vec![0; lent.texels]),
        levels: Vec::leak(vec![Texture::EMPTY; lent.levels]),
        alphas: Vec::leak(vec![0; 64]),
        ..PlayerMemory::default()
    };
    let mut player = Player::new(memory, settings);
    player.start(0);
    player
}

/// What a player says.
type Said = Result<Halt, ListError>;

/// A player at its list, and what it draws, seen from 2 in front of the middle.
fn drawn(draw: impl FnOnce(&mut Scene<'_, 'static, Look>)) -> Vec<u16> {
    let mut vertices = vec![Vertex::EMPTY; 400];
    let mut places = vec![TexturePlace::EMPTY; 400];
    let mut objects = vec![Object::EMPTY; 400];
    let mut bins = vec![0; HEIGHT.into()];
    let mut draws = vec![DrawState::EMPTY; 50];
    let memory = Memory {
        vertices: &mut vertices,
        places: &mut places,
        objects: &mut objects,
        bins: &mut bins,
        draws: &mut draws,
    };
    let mut scene = Scene::new(Screen::new(WIDTH, HEIGHT).unwrap(), memory);
    let eye = Camera::look_at([0.0, 0.0, 2.0], [0.0; 3], [0.0, 1.0, 0.0], 180.0, 0.1, 99.0);
    scene.begin(&eye.unwrap()).unwrap();
    draw(&mut scene);
    let mut cache = FastMemory::<Look, 2>::new();
    let mut links = vec![Link::EMPTY; 400];
    let mut depth = vec![0; WIDTH.into()];
    let mut renderer = Renderer::new(LineMemory {
        cache: &mut cache,
        links: &mut links,
        depth: &mut depth,
    });
    let mut picture = Vec::new();
    for y in 0..HEIGHT {
        let mut line = vec![0; WIDTH.into()];
        renderer.draw_line(&scene, y, &mut line, 0).unwrap();
        picture.extend(line);
    }
    picture
}

/// The next blocks of a list; how many objects there are then.
fn run(player: &mut Player<'static, 'static, Look>, words: impl Words<'static>) -> (Said, usize) {
    let mut done = (Ok(Halt::Stopped), 0);
    drawn(|scene| {
        let said = player.run(words, scene, &mut PLENTY.clone(), &mut |_: Notice| {});
        done = (said, scene.objects());
    });
    done
}

/// The same, with what is told and the offsets of it.
fn told(
    player: &mut Player<'static, 'static, Look>,
    words: impl Words<'static>,
) -> (Said, Vec<(Event, u32)>) {
    let mut told = Vec::new();
    let mut said = Ok(Halt::Stopped);
    drawn(|scene| {
        let tell = &mut |notice: Notice| told.push((notice.event, notice.offset));
        said = player.run(words, scene, &mut PLENTY.clone(), tell);
    });
    (said, told)
}

/// The picture of a list that is played to where it halts so.
fn picture(
    player: &mut Player<'static, 'static, Look>,
    words: impl Words<'static>,
    halt: Halt,
) -> Vec<u16> {
    drawn(|scene| {
        let said = player.run(words, scene, &mut PLENTY.clone(), &mut |_: Notice| {});
        assert_eq!(said, Ok(halt));
    })
}

/// A ring of so many words.
fn ring(words: usize) -> &'static mut ListRing<'static> {
    let memory: Vec<AtomicU32> = (0..words).map(|_| AtomicU32::new(0)).collect();
    std::boxed::Box::leak(std::boxed::Box::new(ListRing::new(Vec::leak(memory))))
}
