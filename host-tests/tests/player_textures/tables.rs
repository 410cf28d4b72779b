//! Texture places of tables, and of strips that come in parts.

use super::*;

/// A table whose faces have two textures of different sides is what a table for each is. Kills: places in texels of the
/// texture before.
#[test]
fn a_table_has_places_on_each_of_its_textures() {
    let mut rng = Rng::new(7);
    let samples = [(1, 3, 5), (2, 5, 3)].map(|(number, log_width, log_height)| {
        let block = TextureBlock {
            number,
            log_width,
            log_height,
            ..sample(&mut rng, TexelForm::Rgb565, false).block
        };
        let words: Vec<u32> = (0..block.words()).map(|_| rng.below(u32::MAX)).collect();
        (block, words)
    });
    let [one, two] = [false, true].map(|again| {
        let mut memory = vec![0; 2048];
        let mut writer = ListWriter::new(&mut memory);
        for (block, words) in &samples {
            writer.bulk(&State::Texture(*block), words).unwrap();
        }
        for (number, face) in [(1, [0u16, 1, 2]), (2, [0, 2, 3])] {
            if number == 1 || again {
                write_table(&mut writer);
            }
            wear(&mut writer, number);
            writer
                .indexed(None, false, face.map(Some).into_iter())
                .unwrap();
        }
        writer.flow(Flow::End).unwrap();
        listed(writer.words(), 64)
    });
    assert!(one.iter().filter(|word| **word != 0).count() > 500);
    assert!(one == two);
}

/// Kills: vertices that come one by one and are put where the places of the table are.
#[test]
fn what_is_drawn_between_leaves_a_table_its_places() {
    let mut rng = Rng::new(9);
    let block = sample(&mut rng, TexelForm::Rgb565, false).block;
    let texels: Vec<u32> = (0..block.words()).map(|_| rng.below(u32::MAX)).collect();
    let [one, two] = [false, true].map(|again| {
        let mut memory = vec![0; 2048];
        let mut writer = ListWriter::new(&mut memory);
        writer.bulk(&State::Texture(block), &texels).unwrap();
        write_table(&mut writer);
        wear(&mut writer, block.number);
        let indexed = |writer: &mut ListWriter<'_>, face: [u16; 3]| {
            let face = face.map(Some).into_iter();
            writer.indexed(None, false, face).unwrap();
        };
        indexed(&mut writer, [0, 1, 2]);
        let header = Header {
            text: true,
            new: true,
            ..Header::of(Id::Short, 3)
        };
        let mut words = Vec::new();
        let mut packer = FieldPacker::new(|w| words.push(w));
        for ([x, y], [u, v]) in CORNERS.into_iter().zip(SIDES).take(3) {
            packer.field(FieldForm::S16x3, [x / 4, y / 4, 0, 0]);
            packer.align();
            packer.field(FieldForm::U16x2, [9_000 - v, u, 0, 0]);
            packer.align();
        }
        writer.vertices(header, &words).unwrap();
        if again {
            write_table(&mut writer);
        }
        indexed(&mut writer, [0, 2, 3]);
        writer.flow(Flow::End).unwrap();
        listed(writer.words(), 64)
    });
    assert!(one.iter().filter(|word| **word != 0).count() > 500);
    assert!(one == two);
}

/// A strip whose vertices find room a few at a time. Kills: places that are lost, or those of other vertices, where it goes
/// on.
#[test]
fn strips_in_parts_have_the_places_of_whole_ones() {
    const COUNT: u16 = 18;
    let mut rng = Rng::new(8);
    let block = sample(&mut rng, TexelForm::Rgb565, false).block;
    let texels: Vec<u32> = (0..block.words()).map(|_| rng.below(u32::MAX)).collect();
    let mut words = Vec::new();
    let mut packer = FieldPacker::new(|w| words.push(w));
    for i in 0..i32::from(COUNT) {
        let y = [-9_000, 9_000][i as usize % 2] + rng.within(-2_000, 2_000);
        packer.field(FieldForm::S16x3, [i * 1_500 - 13_000, y, 0, 0]);
        packer.align();
        let place = [(); 2].map(|()| rng.below(0x8000) as i32);
        packer.field(FieldForm::U16x2, [place[0], place[1], 0, 0]);
        packer.align();
    }
    let mut memory = vec![0; 2048];
    let mut writer = ListWriter::new(&mut memory);
    writer.bulk(&State::Texture(block), &texels).unwrap();
    wear(&mut writer, block.number);
    let header = Header {
        text: true,
        new: true,
        ..Header::of(Id::Short, COUNT)
    };
    writer.vertices(header, &words).unwrap();
    writer.flow(Flow::End).unwrap();
    let list = writer.words();
    let whole = listed(list, 64);
    assert!(whole.iter().filter(|word| **word != 0).count() > 500);
    for room in [4, 5, 7, 12] {
        assert!(listed(list, room) == whole, "{room} vertices at a time");
    }
}

/// The corners of the quad as a table.
fn write_table(writer: &mut ListWriter<'_>) {
    let mut words = Vec::new();
    let mut packer = FieldPacker::new(|w| words.push(w));
    for [x, y] in CORNERS {
        packer.field(FieldForm::S16x3, [x, y, 0, 0]);
    }
    packer.align();
    for [u, v] in SIDES {
        packer.field(FieldForm::U16x2, [u, v, 0, 0]);
    }
    packer.align();
    let header = Header {
        text: true,
        ..Header::of(Id::Table, 4)
    };
    writer.vertices(header, &words).unwrap();
}
