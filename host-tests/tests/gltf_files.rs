//! glTF from outside: what contradicts itself or is too much is refused with its mesh and primitive, and what a list
//! cannot keep is told.

use crate::command_line::Desk;
use base64::Engine as _;
use host_tests::image_out::{Frame, write_image};
use serde_json::{Value, json};
use std::fs;

/// A document and its buffer.
struct Document {
    value: Value,
    bytes: Vec<u8>,
}

impl Document {
    /// A square of two triangles.
    fn new() -> Self {
        let value = json!({
            "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
            "meshes": [{ "primitives": [{ "attributes": {} }] }], "accessors": [], "bufferViews": [],
        });
        let bytes = Vec::new();
        let mut document = Self { value, bytes };
        document.has(
            "POSITION",
            "VEC3",
            &[0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0].map(|c| c as f32),
        );
        let [low, high] = [[0, 0, 0], [1, 1, 0]];
        document.value["accessors"][0]["min"] = json!(low);
        document.value["accessors"][0]["max"] = json!(high);
        document.corners(&[0, 1, 2, 0, 2, 3]);
        document
    }

    /// The same with a picture `p.png` on it.
    fn pictured() -> Self {
        let mut document = Self::new();
        document.has(
            "TEXCOORD_0",
            "VEC2",
            &[0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0],
        );
        document
            .material(json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }));
        document.value["textures"] = json!([{ "source": 0 }]);
        document.value["images"] = json!([{ "uri": "p.png" }]);
        document
    }

    fn primitive(&mut self) -> &mut Value {
        &mut self.value["meshes"][0]["primitives"][0]
    }

    fn material(&mut self, material: Value) {
        self.value["materials"] = json!([material]);
        self.primitive()["material"] = json!(0);
    }

    fn accessor(&mut self, kind: u32, shape: &str, count: usize, bytes: &[u8]) -> usize {
        let view =
            json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        self.bytes.extend(bytes);
        let views = self.value["bufferViews"].as_array_mut().unwrap();
        views.push(view);
        let accessor = json!({
            "bufferView": views.len() - 1, "componentType": kind, "count": count, "type": shape,
        });
        let accessors = self.value["accessors"].as_array_mut().unwrap();
        accessors.push(accessor);
        accessors.len() - 1
    }

    /// Gives it an attribute.
    fn has(&mut self, name: &str, shape: &str, numbers: &[f32]) {
        let bytes: Vec<u8> = numbers.iter().flat_map(|c| c.to_le_bytes()).collect();
        let each = shape.as_bytes()[3] - b'0';
        let number = self.accessor(5126, shape, numbers.len() / usize::from(each), &bytes);
        self.primitive()["attributes"][name] = json!(number);
    }

    /// Gives it corners.
    fn corners(&mut self, corners: &[u32]) {
        let bytes: Vec<u8> = corners.iter().flat_map(|c| c.to_le_bytes()).collect();
        let number = self.accessor(5125, "SCALAR", corners.len(), &bytes);
        self.primitive()["indices"] = json!(number);
    }

    fn text(&self) -> String {
        let data = base64::engine::general_purpose::STANDARD.encode(&self.bytes);
        let mut value = self.value.clone();
        value["buffers"] = json!([{
            "byteLength": self.bytes.len(), "uri": format!("data:;base64,{data}"),
        }]);
        value.to_string()
    }
}

/// A folder with a picture in it.
fn desk() -> Desk {
    let desk = Desk::new("");
    write_image(&desk.path("p.png"), &Frame::new(1, 1, vec![9; 3]).unwrap()).unwrap();
    desk
}

/// What is told of a document that is refused.
fn refused(desk: &Desk, document: &Document) -> String {
    fs::write(desk.path("m.gltf"), document.text()).unwrap();
    desk.refused("bake m.gltf -o m.list")
}

/// What is told of a document that is baked.
fn told(desk: &Desk, document: &Document) -> String {
    fs::write(desk.path("m.gltf"), document.text()).unwrap();
    let output = desk.run("bake m.gltf -o m.list");
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{text}");
    text
}

/// Kills: fewer normals, colours or texture places than positions, the rest made up; colours that are no numbers, made
/// black; corners that are no triangle, left out; a picture drawn by places that are not there.
#[test]
fn primitives_that_contradict_themselves_are_refused() {
    let desk = desk();
    let is_refused = |document: &Document, reason: &str| {
        let text = refused(&desk, document);
        let want = format!("error: m.gltf: mesh 0, primitive 0: {reason}\n");
        assert_eq!(text, want);
    };
    assert_eq!(told(&desk, &Document::new()), "");
    assert_eq!(told(&desk, &Document::pictured()), "");
    for (name, shape, each) in [
        ("NORMAL", "VEC3", 3),
        ("COLOR_0", "VEC3", 3),
        ("TEXCOORD_0", "VEC2", 2),
    ] {
        for count in [1, 3, 5] {
            let mut document = Document::pictured();
            document.has(name, shape, &vec![1.0; each * count]);
            is_refused(
                &document,
                &format!("it has {count} of {name} for 4 positions"),
            );
        }
    }
    for wrong in [f32::NAN, f32::INFINITY] {
        for at in 0..12 {
            let mut document = Document::new();
            let mut levels = [0.5; 12];
            levels[at] = wrong;
            document.has("COLOR_0", "VEC3", &levels);
            is_refused(&document, "a colour is not finite");
        }
    }
    for (mode, count) in [(4, 4), (4, 5), (4, 2), (5, 2), (6, 1)] {
        let mut document = Document::new();
        document.corners(&vec![0; count]);
        document.primitive()["mode"] = json!(mode);
        is_refused(
            &document,
            &format!("{count} corners are no whole triangles"),
        );
    }
    let mut without = Document::new();
    without
        .primitive()
        .as_object_mut()
        .unwrap()
        .remove("indices");
    is_refused(&without, "4 corners are no whole triangles");
    let mut document = Document::pictured();
    document.value["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] =
        json!(1);
    is_refused(&document, "its picture needs TEXCOORD_1, which it has not");
    document.has("TEXCOORD_1", "VEC2", &[0.0; 8]);
    assert_eq!(told(&desk, &document), "");
    // The second of a mesh is named.
    let good = Document::new().primitive().clone();
    let mut second = without.value["meshes"][0].clone();
    second["primitives"].as_array_mut().unwrap().insert(0, good);
    let mut document = Document::new();
    document.value["meshes"] = json!([document.value["meshes"][0], second]);
    document.value["nodes"][0]["mesh"] = json!(1);
    let text = refused(&desk, &document);
    assert!(text.contains("mesh 1, primitive 1: 4 corners"), "{text}");
}

/// A small file places one mesh thousands of times: too many vertices, or too many corners. Kills: a sum over meshes
/// but not over their places; vertices alone or corners alone.
#[test]
fn what_is_placed_too_often_is_refused() {
    let desk = desk();
    let placed = |vertices: usize, corners: usize, times: usize| {
        let mut document = Document::new();
        document.has("POSITION", "VEC3", &vec![0.0; 3 * vertices]);
        let number = document.value["accessors"].as_array().unwrap().len() - 1;
        document.value["accessors"][number]["min"] = json!([0, 0, 0]);
        document.value["accessors"][number]["max"] = json!([0, 0, 0]);
        document.corners(&vec![0; corners]);
        document.value["nodes"] = json!([{ "children": vec![1; times] }, { "mesh": 0 }]);
        document
    };
    let too_much = "as often as its meshes are placed they have";
    for (vertices, corners, times) in [(3_600, 3, 65_000), (4_096, 3, 2_049), (3, 24_576, 1_025)] {
        let text = refused(&desk, &placed(vertices, corners, times));
        let sums = format!(
            "{too_much} {} vertices and {} corners",
            vertices * times,
            corners * times
        );
        assert!(text.contains(&sums), "{text}");
    }
    for (vertices, corners, times) in [(4_096, 3, 20), (3, 24_576, 20)] {
        assert_eq!(told(&desk, &placed(vertices, corners, times)), "");
    }
}

/// Kills: names as they are written; codes that lead out of the folder; a `%` that is no code.
#[test]
fn names_of_files_are_decoded() {
    let desk = desk();
    let picture = fs::read(desk.path("p.png")).unwrap();
    fs::create_dir(desk.path("d")).unwrap();
    for (uri, name) in [
        ("a%20b.png", "a b.png"),
        ("%C3%a4.png", "ä.png"),
        ("d%2Fq.png", "d/q.png"),
        ("100%.png", "100%.png"),
        ("5%2", "5%2"),
        ("%zz%FF.png", "%zz%FF.png"),
    ] {
        let mut document = Document::pictured();
        document.value["images"][0]["uri"] = json!(uri);
        let text = refused(&desk, &document);
        assert!(text.contains(&format!("{uri:?}: No such file")), "{text}");
        fs::write(desk.path(name), &picture).unwrap();
        assert_eq!(told(&desk, &document), "", "{uri}");
    }
    for uri in ["%2E%2E/p.png", "%2Fp.png", "d/%2e%2e/p.png", "file:p.png"] {
        let mut document = Document::pictured();
        document.value["images"][0]["uri"] = json!(uri);
        let text = refused(&desk, &document);
        assert!(text.contains("is not a file in the same folder"), "{text}");
    }
}

/// Kills: a kind that is not told, or told where there is none; what is told once a use instead of once; alphas told of
/// what is opaque anyway.
#[test]
fn what_a_list_cannot_keep_is_told_once_a_kind() {
    let desk = desk();
    let all_told = |document: &Document, lines: &[&str]| {
        let line = |line: &&str| format!("warning: m.gltf: {line}\n");
        assert_eq!(
            told(&desk, document),
            lines.iter().map(line).collect::<String>()
        );
    };
    let with = |pointer: &str, value: Value| {
        let mut document = Document::pictured();
        let (parent, name) = pointer.rsplit_once('/').unwrap();
        document.value.pointer_mut(parent).unwrap()[name] = value;
        document
    };
    let material = |name: &str, value| with(&format!("/materials/0/{name}"), value);
    all_told(
        &material("doubleSided", json!(true)),
        &["doubleSided of materials is left out: 1"],
    );
    all_told(&material("doubleSided", json!(false)), &[]);
    let mask = "alphaMode MASK of materials is left out: 1";
    all_told(&material("alphaMode", json!("MASK")), &[mask]);
    all_told(&material("alphaMode", json!("BLEND")), &[]);
    let transform = json!({ "KHR_texture_transform": { "scale": [4, 4] } });
    let mut document = with(
        "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions",
        transform,
    );
    document.value["extensionsUsed"] = json!(["KHR_texture_transform"]);
    all_told(
        &document,
        &["KHR_texture_transform of materials is left out: 1"],
    );
    let mut document = with("/nodes/0/skin", json!(0));
    document.value["skins"] = json!([{ "joints": [0] }]);
    all_told(&document, &["skins of meshes are left out: 1"]);
    let morphed = |pointer: &str, weight: f64| {
        let mut document = with(pointer, json!([weight]));
        document.primitive()["targets"] = json!([{ "POSITION": 0 }]);
        document
    };
    for pointer in ["/meshes/0/weights", "/nodes/0/weights"] {
        all_told(
            &morphed(pointer, 0.5),
            &["morph weights of meshes are left out: 1"],
        );
        all_told(&morphed(pointer, 0.0), &[]);
    }
    // Alphas of colours and of pictures mean something where the material is not opaque.
    let colours = "alphas of meshes' COLOR_0 are left out: 1";
    for (mode, alpha, lines) in [
        ("BLEND", 0.5, &[colours][..]),
        ("MASK", 0.5, &[mask, colours]),
        ("OPAQUE", 0.5, &[]),
        ("BLEND", 1.0, &[]),
    ] {
        let mut document = material("alphaMode", json!(mode));
        let levels: Vec<f32> = (0..16)
            .map(|at| if at == 7 { alpha } else { 1.0 })
            .collect();
        document.has("COLOR_0", "VEC4", &levels);
        all_told(&document, lines);
        // Placed twice it is told once.
        document.value["nodes"] = json!([{ "mesh": 0 }, { "mesh": 0 }]);
        document.value["scenes"][0]["nodes"] = json!([0, 1]);
        all_told(&document, lines);
    }
    transparent(&desk, "p.png");
    let pictures = "alphas of materials' pictures are left out: 1";
    all_told(&material("alphaMode", json!("BLEND")), &[pictures]);
    all_told(&material("alphaMode", json!("MASK")), &[mask, pictures]);
    all_told(&Document::pictured(), &[]);
    // And of OBJ.
    fs::write(
        desk.path("m.obj"),
        "mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 1 1\nf 1/1 2/1 3/1\n",
    )
    .unwrap();
    fs::write(desk.path("m.mtl"), "newmtl a\nmap_Kd p.png\n").unwrap();
    let said = |line: &str| String::from_utf8(desk.run(line).stderr).unwrap();
    let of_obj = "warning: m.obj: alphas of materials' pictures are left out: ";
    assert_eq!(said("bake m.obj -o m.list"), format!("{of_obj}1\n"));
    assert_eq!(
        said("bake m.obj -o m.list --texture p.png"),
        format!("{of_obj}1\n")
    );
    assert_eq!(said("bake m.obj -o m.list --textures drop"), "");
}

/// Writes a picture of one pixel that is half transparent.
fn transparent(desk: &Desk, name: &str) {
    let file = fs::File::create(desk.path(name)).unwrap();
    let mut encoder = png::Encoder::new(file, 1, 1);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[9, 9, 9, 128]).unwrap();
}
