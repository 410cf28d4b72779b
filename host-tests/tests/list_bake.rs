//! What is baked is the model: within the error asked for, every triangle once, and the committed
//! list is what the baker makes today.

use crate::listing::{blocks, model_of};
use host_tests::lists::bake::{BakeSettings, Baked, bake};
use host_tests::lists::{gltf, print, run};
use host_tests::model::{Model, ModelVertex};
use host_tests::reference::{Shade, View};
use scanbeam::list::{
    Budget, FieldForm, Halt, Header, Instruction, Layout, State, VertexFormat, read_block,
};
use scenes::TEAPOT;
use std::path::Path;

/// The teapot of the scenes, brass.
fn teapot() -> Model {
    model_of(TEAPOT, [236.0, 196.0, 112.0].map(|c| c / 255.0))
}

/// A corner of a triangle that a list draws: place and normal.
type Corner = ([f64; 3], [f64; 3]);

/// The triangles that a baked list draws, read without the runner.
fn triangles_of(list: &[u32]) -> Vec<[Corner; 3]> {
    let mut format = VertexFormat::default();
    let (mut at, mut scale, mut offset) = (0, 1.0, [0.0; 3]);
    let mut table: Vec<Corner> = Vec::new();
    let mut triangles = Vec::new();
    while (at as usize) < list.len() {
        let parsed = read_block(list, at, &format).expect("it is well-formed");
        match parsed.instruction {
            Instruction::State(State::Format(new)) => format = new,
            Instruction::State(State::Matrix(m)) => {
                let real = |m: i32, e: i16| f64::from(m) * 2f64.powi(i32::from(e) - 30);
                scale = real(m.linear[0], m.linear_exponent);
                offset = m.offset.map(|c| real(c, m.offset_exponent));
            }
            Instruction::Table(run) => {
                let layout = Layout::new(&format, run.header);
                let units = |form| match form {
                    FieldForm::S8x3 => [128.0; 3],
                    FieldForm::S10x3 => [1024.0, 1024.0, 512.0],
                    FieldForm::S16x3 => [16_384.0; 3],
                    _ => [f64::from(1 << 30); 3],
                };
                let count = usize::from(run.header.count);
                let place = units(layout.place.form);
                let mut places = vec![[0.0; 3]; count];
                layout.place.column(list, run.at, &mut places, |_, f| {
                    [0, 1, 2].map(|k| f64::from(f[k]) / place[k] * scale + offset[k])
                });
                let mut normals = vec![[0.0; 3]; count];
                if let Some(slot) = layout.normal {
                    let unit = units(slot.form);
                    slot.column(list, run.at, &mut normals, |_, f| {
                        [0, 1, 2].map(|k| f64::from(f[k]) / unit[k])
                    });
                }
                table = places.into_iter().zip(normals).collect();
            }
            Instruction::Indexed(run) => {
                let wide = run.header.low & Header::WIDE != 0;
                let (each, bits, none) = if wide { (2, 16, 0xFFFF) } else { (4, 8, 0xFF) };
                let all: Vec<u32> = (0..u32::from(run.header.count))
                    .map(|n| list[(run.at + n / each) as usize] >> (bits * (n % each)) & none)
                    .collect();
                let mut push = |t: [u32; 3]| triangles.push(t.map(|i| table[i as usize]));
                if run.header.low & Header::SEPARATE != 0 {
                    all.chunks_exact(3).for_each(|t| push([t[0], t[1], t[2]]));
                } else {
                    for strip in all.split(|i| *i == none) {
                        for k in 2..strip.len() {
                            push(match (run.header.rm, k % 2) {
                                (true, _) => [strip[0], strip[k - 1], strip[k]],
                                (false, 0) => [strip[k - 2], strip[k - 1], strip[k]],
                                _ => [strip[k - 1], strip[k - 2], strip[k]],
                            });
                        }
                    }
                }
            }
            _ => {}
        }
        at += parsed.words;
    }
    triangles
}

/// Each triangle of the model has its own in the list, corner by corner within the error.
fn holds(model: &Model, baked: &Baked, error: f64) {
    let mut left = triangles_of(&baked.words);
    assert_eq!(left.len(), baked.triangles);
    assert_eq!(left.len() + baked.dropped, model.triangles.len());
    let mut missing = 0;
    for t in &model.triangles {
        let corners = t.map(|v| model.vertices[v as usize]);
        let near = |c: &Corner, v: &ModelVertex| {
            let d: f64 = (0..3).map(|k| (c.0[k] - v.position[k]).powi(2)).sum();
            let n: f64 = (0..3).map(|k| (c.1[k] - v.normal[k]).powi(2)).sum();
            d.sqrt() <= error * 1.0001 && n.sqrt() < 0.03
        };
        let found = left
            .iter()
            .position(|s| (0..3).any(|turn| (0..3).all(|k| near(&s[(k + turn) % 3], &corners[k]))));
        match found {
            Some(found) => drop(left.swap_remove(found)),
            None => missing += 1,
        }
    }
    assert_eq!((missing, left.len()), (baked.dropped, 0));
}

#[test]
fn every_triangle_is_there_within_the_error() {
    let model = teapot();
    let mut forms = Vec::new();
    for error in [0.02, 0.004, 0.001, 1e-4, 1e-8] {
        let settings = BakeSettings {
            error: Some(error),
            ..BakeSettings::default()
        };
        let baked = bake(&model, &settings).unwrap();
        assert!(baked.error <= error && baked.normal_error <= 1.0);
        holds(&model, &baked, error);
        let meshlets = BakeSettings {
            meshlets: true,
            ..settings
        };
        let in_parts = bake(&model, &meshlets).unwrap();
        assert!(baked.parts == 0 && in_parts.parts > 8);
        holds(&model, &in_parts, error);
        forms.push(baked.place);
    }
    assert_eq!(forms.len(), 5);
    assert!(forms.contains(&FieldForm::S10x3) && forms.contains(&FieldForm::S32x3));
    forms.dedup();
    assert!(forms.len() >= 4, "{forms:?}");
    let settings = BakeSettings {
        error: Some(1e-30),
        ..BakeSettings::default()
    };
    assert!(bake(&model, &settings).is_err());
}

/// The goal is 14 bytes a triangle.
#[test]
fn the_teapot_in_flash_is_what_the_baker_makes() {
    let baked = bake(&teapot(), &BakeSettings::default()).unwrap();
    kept(&baked, "teapot.list", scenes::teapot_list().unwrap());
    assert!(baked.bytes_per_triangle() < 7.0);
    let settings = BakeSettings {
        meshlets: true,
        ..BakeSettings::default()
    };
    let baked = bake(&teapot(), &settings).unwrap();
    let there = scenes::teapot_meshlets_list().unwrap();
    kept(&baked, "teapot_meshlets.list", there);
    assert!(baked.bytes_per_triangle() < 8.0);
}

/// Holds a list against the file of the scenes, and makes that anew where it is another.
fn kept(baked: &Baked, name: &str, there: &[u32]) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../examples/scenes")
        .join(name);
    if there != baked.words {
        let bytes: Vec<u8> = baked.words.iter().flat_map(|w| w.to_ne_bytes()).collect();
        std::fs::write(&file, &bytes).unwrap();
        panic!("{} was another; it is written anew", file.display());
    }
    assert_eq!(run::head(&baked.words).unwrap().table as usize, baked.table);
    assert!(baked.table <= scenes::LIST_TABLE);
    let bytes = 4 * baked.words.len();
    println!(
        "{name}: {bytes} bytes, {:.2} a triangle",
        baked.bytes_per_triangle()
    );
}

#[test]
fn a_baked_model_is_drawn_and_printed() {
    let baked = bake(&teapot(), &BakeSettings::default()).unwrap();
    let view = View {
        eye: [0.0, 1.2, 2.6],
        shade: Shade::Gouraud,
        ..View::default()
    };
    let ran = run::execute(&baked.words, &view, Budget::of(1 << 20)).unwrap();
    assert_eq!((ran.halt, ran.events), (Halt::End, vec![]));
    assert_eq!(ran.counts.triangles as usize, baked.triangles);
    assert!(!ran.is_textured);
    let bright = ran.frame.rgb().iter().filter(|c| **c > 100).count();
    assert!(bright > 10_000, "{bright}");
    // A smaller budget: the list halts, and what stands before is drawn.
    let ran = run::execute(&baked.words, &view, Budget::of(2000)).unwrap();
    assert_eq!(ran.halt, Halt::Budget);
    let (text, error) = print::listing(&baked.words);
    assert_eq!(error, None);
    assert!(
        text.starts_with("00000000      5 words  STATE Head"),
        "{text}"
    );
    let offsets: Vec<&str> = text.lines().filter(|l| !l.starts_with(' ')).collect();
    assert!(offsets.len() > 15 && offsets.last().unwrap().ends_with("FLOW  End"));
    let (text, error) = print::listing(&baked.words[..200]);
    assert!(text.contains("TABLE") || error.unwrap().contains("offset 0x"));
}

#[test]
fn gltf_gives_the_same_triangles_as_obj() {
    let folder = tempfile::tempdir().unwrap();
    // Two triangles of a square, moved by a node and by its parent, indices in bytes.
    let mut data: Vec<u8> = Vec::new();
    for v in [
        [0.0f32, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ] {
        data.extend(v.iter().flat_map(|c| c.to_le_bytes()));
    }
    data.extend([0u8, 1, 2, 0, 2, 3]);
    let json = |buffer: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
            "nodes":[{{"children":[1],"translation":[10,0,0]}},{{"mesh":0,"scale":[2,2,2]}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"material":0}}]}}],
            "materials":[{{"pbrMetallicRoughness":{{"baseColorFactor":[1,0,0,1]}}}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3",
              "min":[0,0,0],"max":[1,1,0]}},
              {{"bufferView":1,"componentType":5121,"count":6,"type":"SCALAR"}}],
            "bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":48}},
              {{"buffer":0,"byteOffset":48,"byteLength":6}}],
            "buffers":[{buffer}]}}"#
        )
    };
    let file = folder.path().join("a.gltf");
    std::fs::write(folder.path().join("a.bin"), &data).unwrap();
    std::fs::write(&file, json(r#"{"uri":"a.bin","byteLength":54}"#)).unwrap();
    let loaded = gltf::load(&file).unwrap();
    let model = &loaded.model;
    assert_eq!(model.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(model.vertices[2].position, [12.0, 2.0, 0.0]);
    assert_eq!(model.vertices[2].normal, [0.0, 0.0, 1.0]);
    assert_eq!(model.vertices[2].colour, [1.0, 0.0, 0.0]);

    // The same as GLB.
    let mut text = json(r#"{"byteLength":54}"#).into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    data.resize(56, 0);
    let mut glb = b"glTF".to_vec();
    let total = 12 + 8 + text.len() + 8 + data.len();
    for word in [
        2,
        total as u32,
        text.len() as u32,
        u32::from_le_bytes(*b"JSON"),
    ] {
        glb.extend(word.to_le_bytes());
    }
    glb.extend(&text);
    glb.extend((data.len() as u32).to_le_bytes());
    glb.extend(b"BIN\0");
    glb.extend(&data);
    let file = folder.path().join("a.glb");
    std::fs::write(&file, &glb).unwrap();
    let mut binary = gltf::load(&file).unwrap();
    assert_eq!(binary.model.sources, [&*file]);
    binary.model.sources.clone_from(&loaded.model.sources);
    assert_eq!(binary, loaded);
    // Cut short anywhere it is refused or read, and never more.
    for len in 0..glb.len() {
        std::fs::write(&file, &glb[..len]).unwrap();
        let _ = gltf::load(&file);
    }
    for buffer in [
        r#"{"uri":"../a.bin","byteLength":54}"#,
        r#"{"uri":"none.bin","byteLength":54}"#,
        r#"{"uri":"a.bin","byteLength":9999}"#,
        r#"{"uri":"data:;base64,AAAA","byteLength":54}"#,
        r#"{"byteLength":54}"#,
    ] {
        let file = folder.path().join("b.gltf");
        std::fs::write(&file, json(buffer)).unwrap();
        assert!(gltf::load(&file).is_err(), "{buffer}");
    }
}

#[test]
fn materials_keep_opacity_and_highlights() {
    let mut model = teapot();
    let material = |d: f64, ks: [f64; 3], ns: f64| host_tests::model::Material {
        ks,
        ns,
        d,
        ..host_tests::model::Material::default()
    };
    model.materials = vec![
        material(0.5, [1.0, 0.5, 0.0], 96.0),
        material(1.0, [9.0, -1.0, 0.2], 1e9),
    ];
    for (n, of) in model.triangle_materials.iter_mut().enumerate() {
        *of = Some(n as u32 / 1128);
    }
    let materials = |normals| {
        let settings = BakeSettings {
            normals,
            ..BakeSettings::default()
        };
        let list = bake(&model, &settings).unwrap().words;
        let all = blocks(&list).into_iter();
        let found = all.filter_map(|(_, instruction)| match instruction {
            Instruction::State(State::Material(m)) => Some((m.opacity, m.specular, m.exponent)),
            _ => None,
        });
        found.collect::<Vec<_>>()
    };
    assert_eq!(
        materials(true),
        [(128, [255, 128, 0], 96), (255, [255, 0, 51], 255)]
    );
    assert_eq!(materials(false), [(128, [0; 3], 0), (255, [0; 3], 0)]);
}
