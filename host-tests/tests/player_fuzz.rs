//! Any bytes do a player no harm: what is refused was refused before anything of it was drawn (X7).

use crate::common::Rng;
use crate::played::lists::{after_a_triangle, draw_textured, texture};
use crate::played::{Kept, drawn};
use scanbeam::event::Notice;
use scanbeam::input::PlayerSettings;
use scanbeam::list::{
    Budget, Flow, Halt, Header, Id, LightWords, ListCommand, Matrix, Palette, State, TexelForm,
};
use scanbeam::look::Textured;
use scanbeam::pixel::Rgb565Be;
use scanbeam::{Affine, Light};

type Skinned = Textured<Rgb565Be>;

/// A list of most of what a player has.
fn rich(rng: &mut Rng) -> Vec<u32> {
    let (mut list, _) = after_a_triangle(|writer| {
        let block = texture(TexelForm::Index4, 1);
        writer
            .bulk(&State::Texture(block), &[0x1020_0102; 2])
            .unwrap();
        let palette = Palette {
            number: 2,
            count: 4,
            at: 0,
        };
        let colours = [0xFF00_FF00, 0xFF12_3456, 0x0000_0000, 0xFFFF_FFFF];
        writer.bulk(&State::Palette(palette), &colours).unwrap();
        let light = LightWords::from(Light::new([0.0, 1.0, 0.4], 0.1).unwrap());
        writer.state(&State::Light { number: 0, light }).unwrap();
        let red = LightWords {
            colour: [200, 0, 0],
            ..light
        };
        let other = State::Light {
            number: 5,
            light: red,
        };
        writer.state(&other).unwrap();
        let matrix = Affine::rotation_y(rng.signed() as f32);
        let matrix = Matrix::try_from(&matrix).unwrap();
        writer.state(&State::Matrix(matrix)).unwrap();
        draw_textured(writer);
        writer.flow(Flow::Pause).unwrap();
        let header = Header {
            shade: true,
            text: true,
            ..Header::of(Id::Table, 8)
        };
        let words = writer.format().table_words(header, 8);
        let data: Vec<u32> = (0..words)
            .map(|_| rng.below(1 << 16) << 16 | rng.below(1 << 16))
            .collect();
        writer.vertices(header, &data).unwrap();
        let indices: Vec<_> = (0..12).map(|_| Some(rng.below(8) as u16)).collect();
        writer.indexed(None, false, indices.into_iter()).unwrap();
        writer.flow(Flow::Sync).unwrap();
        writer.flow(Flow::JumpRelative(1)).unwrap();
        writer.flow(Flow::Pause).unwrap();
        let indices: Vec<_> = (0..9).map(|i| (i != 4).then_some(i % 8)).collect();
        let form = host_tests::lists::writer::Form::Strip;
        writer
            .indexed(Some(form), true, indices.into_iter())
            .unwrap();
        0
    });
    // A block of a later version, before the end.
    let end = list.pop();
    list.extend([0x9100_0100u32.to_le(), 5]);
    list.extend(end);
    list
}

/// Runs any words; whether they were refused before anything was drawn, or drawn to their end.
fn survives(list: &[u32]) -> (bool, bool) {
    let list: &'static [u32] = Vec::leak(list.to_vec());
    let budget = Budget {
        instructions: 64,
        vertices: 4096,
        jumps: 8,
    };
    let mut kept = Kept::new(64, 96).with_lights();
    let mut player = kept.player_with::<Skinned>(
        PlayerSettings {
            camera: true,
            ..PlayerSettings::default()
        },
        4,
        600,
    );
    let (mut refused, mut ended) = (false, false);
    drawn::<Skinned>(|scene| {
        player.start(0);
        // What the budget does not reach is not looked at before.
        let checked = player.check(list, scene.screen(), budget);
        assert_eq!((scene.objects(), scene.vertices()), (0, 0));
        player.start(0);
        let mut left = budget;
        for _ in 0..3 {
            let done = player.run(list, scene, &mut left, &mut |_: Notice| {});
            if let (Err(error), Ok(halt)) = (done, checked) {
                assert!(halt == Halt::Budget, "{error} was not seen before");
            }
            if let Err(first) = checked {
                let again = done.err().filter(|again| again.offset == first.offset);
                refused |= again.is_some();
                assert_eq!(scene.objects() + scene.vertices(), 0, "{first}");
                break;
            }
            ended |= done == Ok(Halt::End);
            player.command(ListCommand::Resume);
        }
        assert!(left.instructions <= budget.instructions);
        assert!(scene.objects() < 20_000);
    });
    (refused, ended)
}

#[test]
fn any_bytes_are_refused_whole_or_drawn() {
    let mut rng = Rng::new(7);
    let (mut refusals, mut ends) = (0, 0);
    let mut count = |list: &[u32]| {
        let (refused, ended) = survives(list);
        refusals += u32::from(refused);
        ends += u32::from(ended);
        ended
    };
    let list = rich(&mut rng);
    assert!(count(&list), "undamaged it comes to its end");
    for len in 0..list.len() {
        count(&list[..len]);
    }
    for bit in 0..32 * list.len() {
        let mut list = list.clone();
        list[bit / 32] ^= 1 << (bit % 32);
        count(&list);
    }
    for _ in 0..2_000 {
        let mut list = rich(&mut rng);
        for _ in 0..1 + rng.below(6) {
            let at = rng.below(list.len() as u32) as usize;
            list[at] = match rng.below(3) {
                0 => 0x1100_0000 | rng.below(1 << 12),
                1 => rng.below(64),
                _ => rng.below(1 << 16) << 16 | rng.below(1 << 16),
            };
        }
        count(&list);
    }
    assert!(refusals > 1_000 && ends > 1_000, "{refusals}, {ends}");
}
