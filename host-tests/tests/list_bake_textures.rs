//! Models baked with their pictures look like the models drawn by calls; pictures are found where
//! OBJ and glTF have them (H7).

use base64::Engine as _;
use host_tests::args::PixelFormatArg;
use host_tests::draw::{CrewSettings, FilterArg, Skins, TextureSet, draw_textured};
use host_tests::image_out::{Frame, encode_image, read_image, write_image};
use host_tests::lists::bake::{BakeSettings, Baked, bake_textured};
use host_tests::lists::sizes::Sizes;
use host_tests::lists::texels::Picture;
use host_tests::lists::{gltf, print, run};
use host_tests::model::{Model, ModelVertex};
use host_tests::reference::View;
use host_tests::texture_file::of_materials;
use scanbeam::list::{Budget, Halt, TexelForm};
use std::path::Path;

const SIDE: u32 = 16;

/// 16 colours in squares.
fn frame() -> Frame {
    let pixel = |x: u32, y: u32| {
        let n = (x / 4 + y / 4 * 4) as u8;
        [n * 17, 255 - n * 9, (n % 3) * 100]
    };
    let rgb = (0..SIDE).flat_map(|y| (0..SIDE).flat_map(move |x| pixel(x, y)));
    Frame::new(SIDE, SIDE, rgb.collect()).unwrap()
}

/// A sheet of squares in an OBJ file, from -1.5 to 2.5 sides of the picture each way, and a triangle
/// without a picture above it.
fn write_obj(folder: &Path) -> Model {
    const N: usize = 9;
    let mut obj = String::from("mtllib m.mtl\n");
    for y in 0..N {
        for x in 0..N {
            let at = |i: usize| i as f64 / (N - 1) as f64;
            let (u, v) = (4.0 * at(x) - 1.5, 4.0 * at(y) - 1.5);
            let place = [2.0 * at(x) - 1.0, at(y) - 0.6, 1.0 - 2.0 * at(y)];
            obj += &format!("v {} {} {}\nvt {u} {v}\n", place[0], place[1], place[2]);
        }
    }
    obj += "v -0.5 0.5 0\nv 0.5 0.5 0\nv 0 1 0\nusemtl sheet\n";
    for y in 0..N - 1 {
        for x in 0..N - 1 {
            let corner = |x: usize, y: usize| 1 + y * N + x;
            let four = [
                corner(x, y),
                corner(x + 1, y),
                corner(x + 1, y + 1),
                corner(x, y + 1),
            ];
            let words: Vec<String> = four.iter().map(|i| format!("{i}/{i}")).collect();
            obj += &format!("f {}\n", words.join(" "));
        }
    }
    let last = N * N;
    obj += &format!("usemtl plain\nf {} {} {}\n", last + 1, last + 2, last + 3);
    std::fs::write(folder.join("m.obj"), obj).unwrap();
    let mtl = "newmtl sheet\nmap_Kd p.png\nnewmtl plain\nKd 0.2 0.4 1\nnewmtl same\nmap_Kd p.png\n";
    std::fs::write(folder.join("m.mtl"), mtl).unwrap();
    write_image(&folder.join("p.png"), &frame()).unwrap();
    Model::load(&folder.join("m.obj")).unwrap()
}

fn pictures(model: &Model) -> Vec<Option<Picture>> {
    let picture = |image| Picture {
        image,
        clamped: false,
    };
    let images = of_materials(model).unwrap().into_iter();
    images.map(|image| image.map(picture)).collect()
}

fn baked(model: &Model, texel_error: f64) -> Baked {
    let settings = BakeSettings {
        texel_error,
        ..BakeSettings::default()
    };
    bake_textured(model, &pictures(model), &settings).unwrap()
}

#[test]
fn a_baked_sheet_looks_like_the_model() {
    let folder = tempfile::tempdir().unwrap();
    let model = write_obj(folder.path());
    let baked = baked(&model, 0.0);
    assert_eq!(baked.places_cut, 0);
    let [texels] = &baked.textures[..] else {
        panic!("two materials share one picture: {}", baked.textures.len());
    };
    assert_eq!((texels.form, texels.palette.len()), (TexelForm::Index4, 16));
    assert_eq!(texels.bytes(), 16 * 16 / 2 + 16 * 4);
    let view = View {
        eye: [0.4, 1.4, 2.6],
        ..View::default()
    };
    let ran = run::execute(&baked.words, &view, Budget::of(1 << 20)).unwrap();
    assert_eq!((ran.halt, ran.events), (Halt::End, vec![]));
    assert!(ran.is_textured);
    let set = TextureSet::load(&model, None).unwrap();
    let skins = Skins {
        set: &set,
        filter: FilterArg::Nearest,
        budget: scanbeam::scene::Budget::EXACT,
    };
    let (format, crew) = (PixelFormatArg::Rgb888, CrewSettings::default());
    let want = draw_textured(&model, skins, &view, format, crew).unwrap();
    let pairs = ran.frame.rgb().chunks(3).zip(want.frame.rgb().chunks(3));
    let (mut same, mut shown, mut off) = (0, 0, 0);
    for (got, want) in pairs {
        if want == [0, 0, 0] && got == [0, 0, 0] {
            continue;
        }
        shown += 1;
        same += u32::from(got == want);
        off += u32::from((0..3).any(|i| got[i].abs_diff(want[i]) > 2));
    }
    // Where they differ it is at the rims of texels, by which a thousandth of the model moves them.
    assert!(
        shown > 15_000 && same > shown * 95 / 100,
        "{same} of {shown}, {off} off"
    );

    // The parts of the report are the whole list, and it is printed.
    let sizes = Sizes::of(&baked.words).unwrap();
    assert_eq!(
        sizes.parts().map(|p| p.1).sum::<usize>(),
        4 * baked.words.len()
    );
    assert_eq!((sizes.texels, sizes.palettes), (128 + 12, 64 + 8));
    let (text, error) = print::listing(&baked.words);
    assert_eq!(error, None);
    for part in ["Texture", "Palette", "texture U16x2", "prsp text"] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

/// A crate with planks on its sides, in 16 colours, and 64 colours above and below.
fn a_crate() -> (Model, Vec<Option<Picture>>) {
    let side = |pixel: &dyn Fn(u32, u32) -> [u8; 3]| {
        let rgb = (0..32).flat_map(|y| (0..32).flat_map(move |x| pixel(x, y)));
        let frame = Frame::new(32, 32, rgb.collect()).unwrap();
        Some(Picture::new(&frame).unwrap())
    };
    let planks = side(&|x, y| {
        let rim = x.min(31 - x).min(y.min(31 - y)) < 4;
        let grain = ((x * 5 + y / 8 * 11) % 7 + u32::from(rim) * 9) as u8;
        [210 - grain * 7, 150 - grain * 6, 80 - grain * 3]
    });
    let lid = side(&|x, y| {
        [
            (x / 4 * 36) as u8,
            (y / 4 * 36) as u8,
            255 - (x * 4) as u8 / 16 * 16,
        ]
    });
    let mut model = Model::default();
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            // Around the side's middle, counter-clockwise seen from outside.
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
            let base = model.vertices.len() as u32;
            for [a, b] in corners {
                let (mut position, mut normal) = ([0.0; 3], [0.0; 3]);
                (normal[axis], position[axis]) = (sign, sign);
                (position[u], position[v]) = (a * sign, b);
                model.vertices.push(ModelVertex {
                    position,
                    normal,
                    colour: [1.0; 3],
                    uv: [a * 0.5 + 0.5, b * 0.5 + 0.5],
                });
            }
            for t in [[0, 1, 2], [0, 2, 3]] {
                model.triangles.push(t.map(|i| base + i));
                model.triangle_materials.push(Some(u32::from(axis == 1)));
            }
        }
    }
    model.materials = vec![host_tests::model::Material::default(); 2];
    (model, vec![planks, lid])
}

#[test]
fn the_crate_in_flash_is_what_the_baker_makes() {
    let (model, pictures) = a_crate();
    let baked = bake_textured(&model, &pictures, &BakeSettings::default()).unwrap();
    let forms: Vec<_> = baked.textures.iter().map(|t| t.form).collect();
    assert_eq!(forms, [TexelForm::Index4, TexelForm::Index8]);
    assert!(baked.textures.iter().all(|t| t.error == 0.0));
    assert_eq!(baked.textures[1].palette.len(), 64);
    let bytes: Vec<u8> = baked.words.iter().flat_map(|w| w.to_ne_bytes()).collect();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes/crate.list");
    let there = std::fs::read(&file).unwrap_or_default();
    if there != bytes {
        std::fs::write(&file, &bytes).unwrap();
        panic!("{} was another; it is written anew", file.display());
    }
    assert_eq!(scenes::crate_list().unwrap(), &baked.words[..]);
    assert!(baked.table <= scenes::CRATE_TABLE);
}

/// Places far apart are moved by whole sides, triangle by triangle where one number does not do.
#[test]
fn places_beyond_sixteen_sides_are_moved_or_said() {
    let folder = tempfile::tempdir().unwrap();
    let mut model = write_obj(folder.path());
    let near = baked(&model, 0.0);
    // Each square of the sheet elsewhere: no longer one sheet, and the same picture.
    for (n, triangle) in model.triangles.iter_mut().take(128).enumerate() {
        let far = [13.0 * (n / 2) as f64 - 300.0, 400.0 - 7.0 * (n / 2) as f64];
        *triangle = triangle.map(|i| {
            let vertex = model.vertices[i as usize];
            let uv = [vertex.uv[0] + far[0], vertex.uv[1] + far[1]];
            model.vertices.push(ModelVertex { uv, ..vertex });
            model.vertices.len() as u32 - 1
        });
    }
    let far = baked(&model, 0.0);
    assert_eq!(far.places_cut, 0);
    let view = View {
        eye: [0.4, 1.4, 2.6],
        ..View::default()
    };
    let draw = |b: &Baked| {
        run::execute(&b.words, &view, Budget::of(1 << 20))
            .unwrap()
            .frame
    };
    let (near, far) = (draw(&near), draw(&far));
    let differ = near.rgb().iter().zip(far.rgb()).filter(|(a, b)| a != b);
    assert!(differ.count() < 300);
    // One triangle across 20 sides is too much.
    let corner = model.triangles[0][0] as usize;
    model.vertices[corner].uv[0] += 20.0;
    assert_eq!(baked(&model, 0.0).places_cut, 1);
}

/// A JPEG of 16 x 8 pixels, red and blue halves.
const JPEG: &str = "/9j/4AAQSkZJRgABAQAAAQABAAD/2wBDABALDA4MChAODQ4SERATGCgaGBYWGDEjJR0oOjM9PDkzODdASFxOQERXRTc4UG1RV19iZ2hnPk1xeXBkeFxlZ2P/2wBDARESEhgVGC8aGi9jQjhCY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2P/wAARCAAIABADAREAAhEBAxEB/8QAHwAAAQUBAQEBAQEAAAAAAAAAAAECAwQFBgcICQoL/8QAtRAAAgEDAwIEAwUFBAQAAAF9AQIDAAQRBRIhMUEGE1FhByJxFDKBkaEII0KxwRVS0fAkM2JyggkKFhcYGRolJicoKSo0NTY3ODk6Q0RFRkdISUpTVFVWV1hZWmNkZWZnaGlqc3R1dnd4eXqDhIWGh4iJipKTlJWWl5iZmqKjpKWmp6ipqrKztLW2t7i5usLDxMXGx8jJytLT1NXW19jZ2uHi4+Tl5ufo6erx8vP09fb3+Pn6/8QAHwEAAwEBAQEBAQEBAQAAAAAAAAECAwQFBgcICQoL/8QAtREAAgECBAQDBAcFBAQAAQJ3AAECAxEEBSExBhJBUQdhcRMiMoEIFEKRobHBCSMzUvAVYnLRChYkNOEl8RcYGRomJygpKjU2Nzg5OkNERUZHSElKU1RVVldYWVpjZGVmZ2hpanN0dXZ3eHl6goOEhYaHiImKkpOUlZaXmJmaoqOkpaanqKmqsrO0tba3uLm6wsPExcbHyMnK0tPU1dbX2Nna4uPk5ebn6Onq8vP09fb3+Pn6/9oADAMBAAIRAxEAPwDFryz7wx6/UD85P//Z";

fn base64(bytes: &[u8]) -> String {
    base64::engine::general_purpose::STANDARD.encode(bytes)
}

/// A triangle with a texture, whose picture and sampler are as given.
fn gltf_text(picture: &str, sampler: &str) -> String {
    let floats = [
        [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].as_slice(),
        [0.25, 0.125, 2.0, 0.0, -1.0, 0.5].as_slice(),
    ];
    let bytes: Vec<u8> = floats
        .concat()
        .iter()
        .flat_map(|f| f.to_le_bytes())
        .collect();
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}},"material":0}}]}}],
        "materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],
        "textures":[{{"source":0,"sampler":0}}],"samplers":[{sampler}],"images":[{picture}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
          "min":[0,0,0],"max":[1,1,0]}},
          {{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}}],
        "bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":36}},
          {{"buffer":0,"byteOffset":36,"byteLength":24}}],
        "buffers":[{{"uri":"data:application/octet-stream;base64,{}","byteLength":60}}]}}"#,
        base64(&bytes)
    )
}

#[test]
fn pictures_of_gltf_are_found_wherever_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let png = encode_image(Path::new("p.png"), &frame()).unwrap();
    std::fs::write(at("p.png"), &png).unwrap();
    let load = |picture: &str, sampler: &str| {
        std::fs::write(at("m.gltf"), gltf_text(picture, sampler)).unwrap();
        gltf::load(&at("m.gltf"))
    };
    let beside = load(r#"{"uri":"p.png"}"#, "{}").unwrap();
    let picture = beside.pictures[0].as_ref().unwrap();
    assert!(!picture.clamped && beside.model.warnings.is_empty());
    for (y, x) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (y, x))) {
        let texel = picture.image.levels[0][(y * SIDE + x) as usize];
        assert_eq!(Some(texel), frame().pixel(x, y));
    }
    // Its places go downwards, those of the model upwards.
    let uv = |n: usize| beside.model.vertices[n].uv;
    assert_eq!(
        [uv(0), uv(1), uv(2)],
        [[0.25, 0.875], [2.0, 1.0], [-1.0, 0.5]]
    );
    let data = format!(r#"{{"uri":"data:image/png;base64,{}"}}"#, base64(&png));
    let mut within = load(&data, "{}").unwrap();
    assert_eq!(within.model.sources, [at("m.gltf")]);
    assert_eq!(beside.model.sources, [at("m.gltf"), at("p.png")]);
    within.model.sources.clone_from(&beside.model.sources);
    assert_eq!(within, beside);
    // A baked one, read as the core reads it, has them again.
    let done = bake_textured(&beside.model, &beside.pictures, &BakeSettings::default()).unwrap();
    assert_eq!((done.triangles, done.textures.len()), (1, 1));

    let clamped = load(r#"{"uri":"p.png"}"#, r#"{"wrapS":33071,"wrapT":33071}"#).unwrap();
    assert!(clamped.pictures[0].as_ref().unwrap().clamped);
    let done = bake_textured(&clamped.model, &clamped.pictures, &BakeSettings::default()).unwrap();
    // A place of -1 would have to move.
    assert!(done.textures[0].clamped && done.places_cut == 1);
    let mirrored = load(r#"{"uri":"p.png"}"#, r#"{"wrapS":33648}"#).unwrap();
    assert_eq!(mirrored.model.warnings.len(), 1);

    let jpeg = format!(r#"{{"uri":"data:image/jpeg;base64,{JPEG}"}}"#);
    let halves = load(&jpeg, "{}").unwrap();
    let image = &halves.pictures[0].as_ref().unwrap().image;
    assert_eq!((image.width, image.height), (16, 8));
    let texel = |x: usize, y: usize| image.levels[0][16 * y + x];
    let near = |a: [u8; 3], b: [u8; 3]| (0..3).all(|i| a[i].abs_diff(b[i]) < 40);
    assert!(near(texel(1, 2), [255, 0, 0]) && near(texel(13, 6), [0, 0, 255]));
    // The same as a file.
    let bytes = base64::engine::general_purpose::STANDARD
        .decode(JPEG)
        .unwrap();
    std::fs::write(at("p.jpg"), &bytes).unwrap();
    assert_eq!(read_image(&at("p.jpg")).unwrap().width(), 16);
    // What is behind the end is passed over.
    std::fs::write(at("p.jpg"), [&bytes[..], b"more"].concat()).unwrap();
    assert_eq!(read_image(&at("p.jpg")).unwrap().width(), 16);
    // Kills: a part of a picture taken for all of it; an end marker within a segment taken for the picture's.
    let comment = [0xFF, 0xD8, 0xFF, 0xFE, 0, 4, 0xFF, 0xD9];
    let commented = [&comment[..], &bytes[2..]].concat();
    std::fs::write(at("p.jpg"), &commented).unwrap();
    assert_eq!(read_image(&at("p.jpg")).unwrap().width(), 16);
    for cut in 0..commented.len() {
        std::fs::write(at("p.jpg"), &commented[..cut]).unwrap();
        let error = read_image(&at("p.jpg")).unwrap_err().to_string();
        assert!(error.contains("is not a good JPEG"), "{cut}: {error}");
    }
    for bad in [
        r#"{"uri":"../p.png"}"#,
        r#"{"uri":"none.png"}"#,
        r#"{"bufferView":1,"mimeType":"image/png"}"#,
        r#"{"uri":"data:image/png;base64,AAAA"}"#,
    ] {
        let error = load(bad, "{}").unwrap_err().to_string();
        assert!(error.contains("picture 0"), "{error}");
    }
}
