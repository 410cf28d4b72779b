//! What scenes and renderers keep from call to call, and what a call leaves that draws nothing.

use crate::frame::{FastMemory, Memory as Lines, Pace, Renderer};
use crate::geometry::{Affine, Camera, Cull, Faces, Mesh, Screen, Sphere};
use crate::link::Link;
use crate::look::{Gouraud, Look, Textured, WordOf};
use crate::num::random::Rng;
use crate::pixel::{Rgb565, Rgb888};
use crate::scene::{
    Draw, DrawError, DrawState, Full, Memory, Object, Scene, ScreenCorner, ScreenVertex, Shadow,
    TexturePlace, Vertex,
};
use std::boxed::Box;
use std::vec::Vec;

pub(super) type Smooth = Gouraud<Rgb565>;

pub(super) const SIDE: u16 = 40;
pub(super) const RED: [u8; 3] = [255, 0, 0];
const BLUE: [u8; 3] = [0, 0, 255];
/// Triangles that face the camera.
pub(super) const NEAR: [[i16; 3]; 3] = at_depth(4_000);
const FAR: [[i16; 3]; 3] = at_depth(-4_000);

const fn at_depth(z: i16) -> [[i16; 3]; 3] {
    [[-16_000, -16_000, z], [16_000, -16_000, z], [0, 16_000, z]]
}

const fn mesh(positions: &[[i16; 3]]) -> Mesh<'_> {
    Mesh {
        positions,
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(&[[0, 1, 2]]),
    }
}

pub(super) fn coloured(positions: &[[i16; 3]], colour: [u8; 3]) -> Draw<'_, 'static> {
    Draw {
        colour,
        ..Draw::new(mesh(positions))
    }
}

fn camera(distance: f32) -> Camera {
    Camera::look_at(
        [0.0, 0.0, distance],
        [0.0; 3],
        [0.0, 1.0, 0.0],
        40.0,
        0.5,
        100.0,
    )
    .unwrap()
}

/// Memory of scenes.
pub(super) struct Rooms {
    vertices: Vec<Vertex>,
    objects: Vec<Object>,
    bins: Vec<u16>,
    draws: Vec<DrawState<'static>>,
    pub(super) places: Vec<TexturePlace>,
}

impl Rooms {
    pub(super) fn new(vertices: usize, draws: usize) -> Self {
        Self {
            vertices: std::vec![Vertex::EMPTY; vertices],
            objects: std::vec![Object::EMPTY; 40],
            bins: std::vec![0; SIDE.into()],
            draws: std::vec![DrawState::EMPTY; draws],
            places: Vec::new(),
        }
    }

    /// All of it.
    pub(super) fn memory(&mut self) -> Memory<'_, 'static> {
        Memory {
            vertices: &mut self.vertices,
            places: &mut self.places,
            objects: &mut self.objects,
            bins: &mut self.bins,
            draws: &mut self.draws,
        }
    }

    /// A scene for as many columns, and one line or a square.
    pub(super) fn scene<L: Look>(&mut self, width: u16, height: u16) -> Scene<'_, 'static, L> {
        let mut scene = Scene::new(Screen::new(width, height).unwrap(), self.memory());
        scene.begin(&camera(2.0)).unwrap();
        scene
    }
}

/// Memory of a renderer.
struct Room<L: Look> {
    cache: Box<FastMemory<L>>,
    links: [Link; 40],
    depth: Vec<u32>,
}

impl<L: Look> Room<L> {
    fn new(slots: u16, depth: u16) -> Self {
        let mut cache = Box::new(FastMemory::new());
        cache.set_limit(slots);
        Self {
            cache,
            links: [Link::NONE; 40],
            depth: std::vec![0; depth.into()],
        }
    }

    fn renderer(&mut self) -> Renderer<'_, L> {
        Renderer::new(Lines {
            cache: &mut self.cache,
            links: &mut self.links,
            depth: &mut self.depth,
        })
    }
}

/// A line of a scene on black.
fn line<L: Look>(
    renderer: &mut Renderer<'_, L>,
    scene: &Scene<'_, '_, L>,
    line: u16,
) -> Vec<WordOf<L>> {
    let black = WordOf::<L>::default();
    let mut pixels = std::vec![black; scene.screen().width().into()];
    renderer.draw_line(scene, line, &mut pixels, black).unwrap();
    pixels
}

/// The pixel in the middle of what a fresh renderer draws.
fn middle(scene: &Scene<'_, '_, Smooth>) -> u16 {
    line(&mut Room::new(32, SIDE).renderer(), scene, 25)[20]
}

/// Kills: changes that each scene counts for itself.
#[test]
fn a_scene_is_not_taken_for_one_that_had_its_memory() {
    let mut rooms = Rooms::new(90, 9);
    let mut room = Room::<Smooth>::new(32, SIDE);
    let mut renderer = room.renderer();
    for (colour, at, pixel) in [(RED, 25, 0xF800), (BLUE, 30, 0x001F)] {
        let mut scene = rooms.scene(SIDE, SIDE);
        scene.draw(&coloured(&NEAR, colour)).unwrap();
        assert_eq!(line(&mut renderer, &scene, at)[20], pixel);
    }
}

/// Kills: light of 24 bits that begins anew where a run does.
#[test]
fn light_is_that_of_the_span_wherever_a_run_begins() {
    for seed in 0..400 {
        let mut rng = Rng(seed);
        let mut corner = |x, y| ScreenCorner {
            vertex: ScreenVertex {
                x,
                y,
                depth: 1 << 30,
                colour: [(); 3].map(|()| rng.below(256) as u8),
            },
            texel: [0; 2],
        };
        // The last is seen, over 16 others, which fill the list of those without a slot.
        let mut list = [(); 17].map(|()| [corner(0, -40), corner(1600, -40), corner(800, 60)]);
        list[16] = [corner(-100, -40), corner(1800, -30), corner(700, 60)];
        let mut rooms = Rooms::new(90, 2);
        let mut scene = rooms.scene::<Textured<Rgb888>>(200, 1);
        scene
            .draw_screen(
                &Draw {
                    cull: Cull::None,
                    ..Draw::new(mesh(&[]))
                },
                &list,
            )
            .unwrap();
        let with = |slots: u16| line(&mut Room::new(slots, 0).renderer(), &scene, 0);
        assert_eq!(with(32), with(0), "{seed}");
    }
}

/// Kills: a priority of a call that is skipped, or has no pixels, that is not looked at.
#[test]
fn a_call_that_draws_nothing_ranks_the_scene_as_one_that_does() {
    let away = at_depth(0);
    let hud = Draw {
        model: Affine::placed(1.0, [500.0, 0.0, 0.0]).unwrap(),
        priority: 1,
        ..coloured(&away, RED)
    };
    for call in 0..4 {
        let mut rooms = Rooms::new(90, 9);
        let mut scene = rooms.scene::<Smooth>(SIDE, SIDE);
        scene.draw(&coloured(&NEAR, RED)).unwrap();
        scene.draw(&coloured(&FAR, BLUE)).unwrap();
        match call {
            0 => scene.draw(&hud).unwrap(),
            1 => assert_eq!(scene.draw_within(&hud, &Sphere::around(&away)), Ok(false)),
            _ => scene.draw_points(&hud, call - 2).unwrap(),
        }
        assert_eq!(middle(&scene), 0x001F, "{call}");
    }
}

/// Kills: a corner that a plane made, taken for the last vertex that there can be.
#[test]
fn the_last_vertex_that_a_face_can_have_is_cut_as_others_are() {
    let pixels = |last: u16| {
        let mut positions = std::vec![[0; 3]; 65_536];
        positions[0] = [-8_000, -8_000, -8_000];
        positions[1] = [8_000, -8_000, -8_000];
        positions[usize::from(last)] = [0, 8_000, 32_000];
        // Not enough for all: each face brings its own.
        let mut rooms = Rooms::new(60_000, 9);
        let mut scene = rooms.scene::<Smooth>(SIDE, SIDE);
        scene.begin(&camera(1.5)).unwrap();
        let faces = Faces::Triangles(&[[0, 1, last]]);
        let mesh = Mesh {
            faces,
            ..mesh(&positions)
        };
        scene
            .draw(&Draw {
                cull: Cull::None,
                ..Draw::new(mesh)
            })
            .unwrap();
        let mut room = Room::new(32, SIDE);
        let mut renderer = room.renderer();
        (0..SIDE)
            .map(|y| line(&mut renderer, &scene, y))
            .collect::<Vec<_>>()
    };
    assert_eq!(pixels(65_535), pixels(65_534));
}

/// Kills: a cost of nothing, taken for nobody to compare with.
#[test]
fn spans_are_compared_where_that_costs_nothing() {
    let (left, right) = (
        [
            [-16_000, -16_000, 8_000],
            [16_000, -16_000, -8_000],
            [0, 16_000, 0],
        ],
        [
            [-16_000, -16_000, -8_000],
            [16_000, -16_000, 8_000],
            [0, 16_000, 0],
        ],
    );
    let mut rooms = Rooms::new(90, 9);
    let mut scene = rooms.scene::<Smooth>(SIDE, SIDE);
    scene.draw(&coloured(&left, RED)).unwrap();
    scene.draw(&coloured(&right, BLUE)).unwrap();
    let mut room = Room::new(32, SIDE);
    let pace = Pace {
        pair: 0,
        ..Pace::GOURAUD_M4
    };
    let paced = line(&mut room.renderer().paced(pace), &scene, 30);
    assert_eq!(paced, line(&mut Room::new(32, SIDE).renderer(), &scene, 30));
}

/// Kills: a shadow of a call that found no room, by which the scene is ruled from then on.
#[test]
fn a_shadow_that_found_no_room_rules_nothing() {
    let mut rooms = Rooms::new(90, 1);
    let mut scene = rooms.scene::<Smooth>(SIDE, SIDE);
    scene.draw(&coloured(&NEAR, RED)).unwrap();
    let full = Err(DrawError::Full {
        memory: Full::Draws,
        triangles: 1,
        first_face: 0,
    });
    let lit = Draw {
        shadow: Some(Shadow::Lit(0)),
        ..coloured(&NEAR, RED)
    };
    assert_eq!(scene.draw(&lit), full);
    assert_eq!(
        scene.draw(&Draw {
            priority: 1,
            ..coloured(&NEAR, RED)
        }),
        full
    );
    assert_eq!(middle(&scene), 0xF800);
}
