//! Strips of lists that other blocks stand behind: all that was gathered of them is drawn, and nothing else (H7, H11).

use crate::common::Rng;
use crate::hot::NO_MESH;
use crate::listing::{Cloud, PLENTY, some_format, unrolled};
use crate::played::{HEIGHT, Kept, WIDTH, drawn, played};
use crate::player_tables::listed;
use host_tests::lists::writer::ListWriter;
use scanbeam::input::PlayerSettings;
use scanbeam::list::{Flow, Halt, Header, Id, State, VertexFormat};
use scanbeam::look::Gouraud;
use scanbeam::mesh::{QuadSplit, ScreenVertex};
use scanbeam::pixel::Rgb565Be;
use scanbeam::scene::{Draw, Scene, ScreenCorner};
use scanbeam::{Cull, Faces, Mesh};

type Smooth = Gouraud<Rgb565Be>;

const COUNT: u32 = 24;

/// Vertices of a list, and their format.
struct Vertices {
    cloud: Cloud,
    format: VertexFormat,
}

impl Vertices {
    fn random(rng: &mut Rng) -> Self {
        let (format, place, normal) = some_format(rng);
        let cloud = Cloud::random(rng, COUNT as usize, place, normal);
        Self { cloud, format }
    }

    /// A block of some of them.
    fn write(&self, writer: &mut ListWriter<'_>, id: Id, new: bool, order: &[u16]) {
        let header = Header {
            shade: true,
            new,
            ..Header::of(id, order.len() as u16)
        };
        let words = self.cloud.vertices(&self.format, header, order);
        writer.vertices(header, &words).unwrap();
    }

    fn strip(&self, scene: &mut Scene<'_, '_, Smooth>, order: &[u16]) {
        self.draw(scene, Faces::Triangles(&unrolled(order, false)));
    }

    fn draw(&self, scene: &mut Scene<'_, '_, Smooth>, faces: Faces<'_>) {
        let mesh = Mesh {
            faces,
            ..self.cloud.plain(true, &self.format)
        };
        scene.draw(&call(mesh)).unwrap();
    }

    /// Those of a block as points.
    fn points(&self, scene: &mut Scene<'_, '_, Smooth>, order: &[u16]) {
        let all = self.cloud.plain(true, &self.format);
        let positions: Vec<_> = picked(all.positions, order);
        let normals: Vec<_> = picked(all.normals, order);
        let colours: Vec<_> = picked(all.colours, order);
        let mesh = Mesh {
            positions: &positions,
            normals: &normals,
            colours: &colours,
            faces: Faces::Triangles(&[]),
        };
        scene.draw_points(&call(mesh), 1).unwrap();
    }
}

/// What a list draws a mesh as.
fn call(mesh: Mesh<'_>) -> Draw<'_, 'static> {
    Draw {
        mesh,
        cull: Cull::None,
        ..PlayerSettings::default().draw
    }
}

/// Values of vertices, where there are any.
fn picked<T: Copy>(values: &[T], order: &[u16]) -> Vec<T> {
    let at = |&i: &u16| values.get(usize::from(i)).copied();
    order.iter().filter_map(at).collect()
}

/// Some vertices by their numbers.
fn some(rng: &mut Rng, count: u32) -> Vec<u16> {
    (0..count).map(|_| rng.below(COUNT) as u16).collect()
}

/// What a list draws that ends here.
fn ended(writer: &mut ListWriter<'_>) -> Vec<u16> {
    writer.flow(Flow::End).unwrap();
    listed(writer.words(), call(NO_MESH), (64, 96))
}

/// Kills: vertices of a strip that are points as well; quads of other corners than theirs.
#[test]
fn quads_and_points_are_no_part_of_a_strip() {
    for seed in 0..40 {
        let mut rng = Rng::new(seed);
        let vertices = Vertices::random(&mut rng);
        let [first, second, third] = [4, 4, 5].map(|count| some(&mut rng, count));
        for between in [Id::Quads, Id::Points] {
            let mut memory = vec![0; 2048];
            let mut writer = ListWriter::new(&mut memory);
            writer.state(&State::Format(vertices.format)).unwrap();
            vertices.write(&mut writer, Id::Short, true, &first);
            vertices.write(&mut writer, between, false, &second);
            vertices.write(&mut writer, Id::Short, true, &third);
            let got = ended(&mut writer);
            let want = drawn::<Smooth>(|scene| {
                vertices.strip(scene, &first);
                if between == Id::Quads {
                    let (quads, _) = second.as_chunks::<4>();
                    vertices.draw(scene, Faces::Quads(quads, QuadSplit::Corner0To2));
                } else {
                    vertices.points(scene, &second);
                }
                vertices.strip(scene, &third);
            });
            assert!(got == want, "seed {seed}, {between:?}");
        }
    }
}

/// Kills: what was gathered before vertices on the screen is lost, or gathered with what follows them.
#[test]
fn vertices_on_the_screen_stand_between_others() {
    for seed in 0..40 {
        let mut rng = Rng::new(seed);
        let vertices = Vertices::random(&mut rng);
        let corners = [(); 3].map(|()| ScreenVertex {
            x: rng.below(8 * u32::from(WIDTH)) as i16,
            y: rng.below(8 * u32::from(HEIGHT)) as i16,
            depth: rng.below(1 << 31),
            colour: [(); 3].map(|()| rng.below(256) as u8),
        });
        let [first, second] = [5, 6].map(|count| some(&mut rng, count));
        let mut memory = vec![0; 2048];
        let mut writer = ListWriter::new(&mut memory);
        writer.state(&State::Format(vertices.format)).unwrap();
        vertices.write(&mut writer, Id::Short, true, &first);
        let header = Header {
            shade: true,
            prsp: true,
            new: true,
            ..Header::of(Id::Long, 3)
        };
        let words = corners.map(|v| {
            let place = u32::from(v.x as u16) | u32::from(v.y as u16) << 16;
            let [r, g, b] = v.colour;
            [place, v.depth, u32::from_le_bytes([r, g, b, 255])]
        });
        writer.vertices(header, words.as_flattened()).unwrap();
        vertices.write(&mut writer, Id::Short, true, &second);
        let got = ended(&mut writer);
        let want = drawn::<Smooth>(|scene| {
            vertices.strip(scene, &first);
            let triangle = corners.map(|vertex| ScreenCorner {
                vertex,
                texel: [0; 2],
            });
            scene
                .draw_screen(
                    &call(vertices.cloud.plain(false, &vertices.format)),
                    &[triangle],
                )
                .unwrap();
            vertices.strip(scene, &second);
        });
        assert!(got == want, "seed {seed}");
    }
}

/// Kills: a draw call for vertices that make no triangle.
#[test]
fn two_vertices_on_the_screen_are_no_call() {
    let mut memory = vec![0; 64];
    let mut writer = ListWriter::new(&mut memory);
    let header = Header {
        new: true,
        ..Header::of(Id::Long, 2)
    };
    writer.vertices(header, &[0; 2]).unwrap();
    writer.flow(Flow::End).unwrap();
    let mut kept = Kept::new(64, 96);
    let mut player = kept.player::<Smooth>(PlayerSettings::default());
    drawn::<Smooth>(|scene| {
        player.start(0);
        assert_eq!(
            played(&mut player, writer.words(), scene, PLENTY),
            Ok(Halt::End)
        );
    });
    let counts = player.counts();
    assert_eq!((counts.vertices, counts.draws), (2, 0));
}
