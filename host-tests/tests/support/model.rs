//! Each well-formed and each malformed case, on text in the source.

use host_support::model::*;
use std::path::Path;

fn read(text: &str) -> Result<Model, ModelError> {
    Model::from_obj_text(text, Path::new("m.obj"))
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

/// The error as the user sees it.
fn refusal(text: &str) -> String {
    let line = read(text).expect_err("must be refused").to_string();
    assert_eq!(line.lines().count(), 1, "one line: {line:?}");
    line
}

const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

#[test]
fn a_triangle_gets_white_and_a_computed_normal() {
    let model = read(&format!("{CORNERS}f 1 2 3\n")).unwrap();
    assert_eq!(model.triangles, [[0, 1, 2]]);
    assert_eq!(model.triangle_materials, [None]);
    for vertex in &model.vertices {
        assert_eq!(vertex.colour, [1.0; 3]);
        assert_eq!(vertex.normal, [0.0, 0.0, 1.0]);
        assert_eq!(vertex.uv, [0.0; 2]);
    }
    assert_eq!(model.bounds(), Some(([0.0; 3], [1.0, 1.0, 0.0])));
}

#[test]
fn no_triangles_is_valid() {
    for text in ["", "\n\n", "# only a comment", CORNERS, "\u{feff}"] {
        let mut model = read(text).unwrap();
        let told = warnings(&model);
        assert_eq!(told, ["m.obj: it has no faces, so nothing is drawn"]);
        model.warnings.clear();
        assert_eq!(model, Model::default());
    }
    assert_eq!(Model::default().bounds(), None);
}

#[test]
fn colours_of_some_vertices_only() {
    let model = read("v 0 0 0\nv 1 0 0 0.25 0.5 2\nv 0 1 0 1\nf 1 2 3").unwrap();
    let colours: Vec<_> = model.vertices.iter().map(|v| v.colour).collect();
    assert_eq!(colours, [[1.0; 3], [0.25, 0.5, 1.0], [1.0; 3]]);
}

#[test]
fn negative_indices_count_back_from_here() {
    let ahead = format!("f 1 2 3\n{CORNERS}");
    assert_eq!(read(&ahead).unwrap().triangles, [[0, 1, 2]]);
    let back = format!("{CORNERS}f -3 -2 -1\nv 9 9 9\n");
    assert_eq!(read(&back).unwrap().vertices[2].position, [0.0, 1.0, 0.0]);
}

#[test]
fn polygons_are_fans() {
    let model = read("v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nf 1 2 3 4 5").unwrap();
    assert_eq!(model.triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
}

#[test]
fn corners_are_shared_only_when_all_indices_agree() {
    let text = format!("{CORNERS}v 1 1 0\nvt 0 0\nvt 1 1\nvn 0 0 5\nf 1/1/1 2/1/1 3/1/1\n");
    let same = read(&format!("{text}f 3/1/1 2/1/1 4/1/1")).unwrap();
    assert_eq!(same.vertices.len(), 4);
    let other = read(&format!("{text}f 3/2/1 2//1 4/1")).unwrap();
    assert_eq!(other.vertices.len(), 6);
    assert_eq!(other.vertices[3].uv, [1.0, 1.0]);
    assert_eq!(other.vertices[0].normal, [0.0, 0.0, 1.0], "normalised");
}

#[test]
fn computed_normals_are_weighted_by_area() {
    // A large triangle facing z and a small one facing x share the first two corners.
    let model = read("v 0 0 0\nv 0 2 0\nv -3 0 0\nv 0 0 -1\nf 1 2 3\nf 1 4 2").unwrap();
    let expected = unit([2.0, 0.0, 6.0]);
    for (axis, expected) in expected.into_iter().enumerate() {
        assert!((model.vertices[0].normal[axis] - expected).abs() < 1e-15);
    }
    assert_eq!(model.vertices[2].normal, [0.0, 0.0, 1.0]);
}

#[test]
fn zero_area_gives_a_zero_normal_not_nan() {
    let model = read("v 0 0 0\nv 1 1 1\nf 1 2 2\nf 1 1 1").unwrap();
    assert!(model.vertices.iter().all(|v| v.normal == [0.0; 3]));
}

#[test]
fn comments_continuations_and_line_ends() {
    let model = read("# \\\r\nv 0 0 0 # why\r\n  v 1 0 \\\r\n 0\r\nv 0 1 0\r\ns off\r\nf 1 2 3");
    assert_eq!(model.unwrap().vertices[1].position, [1.0, 0.0, 0.0]);
    assert_eq!(
        refusal("v 0 0 0\nv 1 \\\n0 0\nv 1 2"),
        "m.obj:4: `v` needs 3 (or 4, 6, 7) numbers, found 2"
    );
    assert!(read("v 1 2 3 \\").is_ok(), "a continuation at the end");
}

#[test]
fn many_continuations_take_linear_time() {
    let text = format!("v 1 {}\n2 3", "\\\n".repeat(300_000));
    assert!(
        refusal(&text).starts_with("m.obj:1: "),
        "the last piece is a line of its own"
    );
    let text = format!("v 1 {}2 3", "\\\n".repeat(300_000));
    assert!(read(&text).is_ok());
}

#[test]
fn malformed_lines_are_named() {
    for (line, reason) in [
        ("v 1 2", "`v` needs 3 (or 4, 6, 7) numbers, found 2"),
        ("v", "`v` needs 3 (or 4, 6, 7) numbers, found 0"),
        ("v 1 2 3 4 5", "`v` needs 3 (or 4, 6, 7) numbers, found 5"),
        ("v 1 2 x", "\"x\" is not a number"),
        ("v 1 2 0x10", "\"0x10\" is not a number"),
        ("v NaN 2 3", "\"NaN\" is not a finite number"),
        ("v 1 -inf 3", "\"-inf\" is not a finite number"),
        ("v 1 1e999 3", "\"1e999\" is not a finite number"),
        ("v 1 1e39 3", "\"1e39\" is too large a number"),
        ("v 0 0 0 nan 0 0", "\"nan\" is not a finite number"),
        ("vn 0 1", "`vn` needs 3 numbers, found 2"),
        ("vn 0 infinity 1", "\"infinity\" is not a finite number"),
        ("vt", "`vt` needs 1 to 3 numbers, found 0"),
        ("vt 1 2 3 4", "`vt` needs 1 to 3 numbers, found 4"),
        ("f", "a face needs at least 3 corners, found 0"),
        ("f 1 2", "a face needs at least 3 corners, found 2"),
        (
            "f 0 1 2",
            "index \"0\" in \"0\" is 0, but OBJ counts from 1",
        ),
        (
            "f 1 2 4",
            "index 4 is out of range: the file has 3 vertices",
        ),
        ("f 1 2 -4", "index \"-4\" in \"-4\" is out of range"),
        (
            "f 99999999999 1 2",
            "index \"99999999999\" in \"99999999999\" is out of range",
        ),
        (
            "f 4294967296 1 2",
            "index \"4294967296\" in \"4294967296\" is out of range",
        ),
        (
            "f 4294967295 1 2",
            "index 4294967295 is out of range: the file has 3 vertices",
        ),
        (
            "f 1 2 -9223372036854775808",
            "index \"-9223372036854775808\" in \"-9223372036854775808\" is out of range",
        ),
        (
            "f 1 2 99999999999999999999",
            "index \"99999999999999999999\" in \"99999999999999999999\" is out of range",
        ),
        ("f 1/2/3/4/5 2 3", "index \"2\" in"),
        ("f 1///1 2 3", "corner \"1///1\" has too many parts"),
        (
            "f 1/1 2/1 3/1",
            "index 1 is out of range: the file has 0 texture places",
        ),
        (
            "f 1//1 2//1 3//1",
            "index 1 is out of range: the file has 0 normals",
        ),
        ("f /1/1 2 3", "corner \"/1/1\" has no vertex"),
        (
            "f 1.5 2 3",
            "index \"1.5\" in \"1.5\" is not a whole number",
        ),
        ("f 1 - 3", "index \"-\" in \"-\" is not a whole number"),
        ("f a b c", "index \"a\" in \"a\" is not a whole number"),
        ("hello", "\"hello\" is not an OBJ keyword"),
        (
            "\0\u{1}\u{7f}",
            "\"\\0\\u{1}\\u{7f}\" is not an OBJ keyword",
        ),
    ] {
        if line.starts_with("f 1/2/3/4/5") {
            assert!(refusal(&format!("{CORNERS}{line}\n")).contains("too many parts"));
            continue;
        }
        assert_eq!(
            refusal(&format!("{CORNERS}{line}\n")),
            format!("m.obj:4: {reason}")
        );
    }
}

#[test]
fn files_that_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let missing = Model::load(&folder.path().join("no.obj")).unwrap_err();
    assert!(
        missing.to_string().contains("no.obj: cannot be read"),
        "{missing}"
    );
    let error = Model::load(folder.path()).unwrap_err();
    assert!(error.to_string().contains("cannot be read"), "{error}");
    let error = ModelError {
        file: "a\nb".into(),
        line: None,
        reason: "x\ty".into(),
    };
    assert_eq!(error.to_string(), "a?b: x?y");
}

#[test]
fn materials_multiply_colours() {
    let folder = tempfile::tempdir().unwrap();
    let obj = folder.path().join("m.obj");
    let mtl = "newmtl red one\nKd 1 0.5 0\nKs .1 .2 .3\nNs 8\nd 0.5\nmap_Kd a b.png\nnewmtl grey\nKd 0.5\nPr 1\n";
    std::fs::write(folder.path().join("the lib.mtl"), mtl).unwrap();
    let text = format!(
        "mtllib the lib.mtl\n{CORNERS}f 1 2 3\nusemtl red one\nf 1 2 3\nusemtl grey\nf 1 2 3\n"
    );
    std::fs::write(&obj, &text).unwrap();
    let model = Model::load(&obj).unwrap();
    assert_eq!(model.triangle_materials, [None, Some(0), Some(1)]);
    assert_eq!(
        model.vertices.len(),
        9,
        "a material is part of what makes a vertex"
    );
    assert_eq!(model.vertices[3].colour, [1.0, 0.5, 0.0]);
    assert_eq!(model.vertices[6].colour, [0.5; 3]);
    let red = &model.materials[0];
    assert_eq!((red.ks, red.ns, red.d), ([0.1, 0.2, 0.3], 8.0, 0.5));
    assert_eq!(red.map_kd, Some(folder.path().join("a b.png")));
    assert!(model.warnings.is_empty());
    for (mtl, line, reason) in [
        ("Kd 1 1 1", 1, "`Kd` before `newmtl`"),
        ("newmtl a\nKd 1 2", 2, "`Kd` needs 3 numbers, found 2"),
        (
            "newmtl a\n\nKs 1 nan 2",
            3,
            "\"nan\" is not a finite number",
        ),
        ("newmtl a\nNs", 2, "`Ns` needs 1 number, found 0"),
        ("newmtl", 1, "`newmtl` needs a name"),
    ] {
        std::fs::write(folder.path().join("the lib.mtl"), mtl).unwrap();
        let error = Model::load(&obj).unwrap_err();
        assert_eq!(error.file, folder.path().join("the lib.mtl"));
        assert_eq!((error.line, error.reason.as_str()), (Some(line), reason));
    }
}

/// The warnings as the user sees them.
fn warnings(model: &Model) -> Vec<String> {
    model.warnings.iter().map(ModelError::to_string).collect()
}

#[test]
fn materials_that_cannot_be_found_are_white_with_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let obj = folder.path().join("m.obj");
    let load = |text: &str| {
        std::fs::write(&obj, text).unwrap();
        let model = Model::load(&obj).unwrap();
        assert_eq!(model.triangle_materials, [None]);
        assert_eq!(model.vertices[0].colour, [1.0; 3]);
        warnings(&model)
    };
    let at = |line: usize, reason: &str| format!("{}:{line}: {reason}", obj.display());

    let text = format!("mtllib a b.mtl\nmtllib a b.mtl\n{CORNERS}usemtl blue\nf 1 2 3\n");
    assert_eq!(
        load(&text),
        [at(1, "material file \"a b.mtl\" is not there")],
        "named once, and the names in it not at all"
    );
    std::fs::write(folder.path().join("b.mtl"), "newmtl red\nKd 1 0 0\n").unwrap();
    assert_eq!(load(&text), [at(1, "material file \"a\" is not there")]);
    let text = format!("mtllib b.mtl\n{CORNERS}usemtl blue\nf 1 2 3\n");
    let missing = at(5, "material \"blue\" is in no material file");
    assert_eq!(load(&text), [missing]);
    let text = format!("mtllib b.mtl\n{CORNERS}usemtl red\nusemtl\nf 1 2 3\n");
    assert!(load(&text).is_empty(), "no name: no material");
    assert_eq!(
        load(&format!("mtllib\n{CORNERS}f 1 2 3\n")),
        [at(1, "`mtllib` needs a name")]
    );
    // Files without any library often name materials all the same: one line for all names.
    let text = format!("{CORNERS}usemtl blue\nusemtl red\nf 1 2 3\n");
    let told = "material \"blue\" is in no material file, and the model names none: all is white";
    assert_eq!(load(&text), [at(4, told)]);
}

#[test]
fn a_library_in_a_folder_is_found_with_either_slash() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    let mtl = "newmtl red\nKd 1 0 0\nmap_Kd -s 2 2 1 a.png\n";
    std::fs::write(folder.path().join("sub/x.mtl"), mtl).unwrap();
    for name in ["sub/x.mtl", "sub\\x.mtl", ".\\sub\\x.mtl"] {
        let text = format!("mtllib {name}\n{CORNERS}usemtl red\nf 1 2 3\n");
        let model = Model::from_obj_text(&text, &folder.path().join("m.obj")).unwrap();
        assert_eq!(model.vertices[0].colour, [1.0, 0.0, 0.0]);
        assert_eq!(model.materials[0].map_kd, None);
        let warnings = warnings(&model);
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(
            warnings[0].ends_with(":3: options of `map_Kd` are not supported: it is left out"),
            "{warnings:?}"
        );
    }
}

#[test]
fn what_draws_nothing_is_passed_over() {
    let text = format!(
        "\u{feff}# made by hand\r\nmg 1 0.5\r\no thing\r\ng\r\ng a b\r\ns 1\r\ns off\r\n{CORNERS}vp 0.5\nvp 0.1 0.2 0.3\n\
         l 1 2\nl 1/1 2/1\np 1 2 3\nlod 3\nbevel on\ncstype rat bspline\ndeg 2\n\
         curv 0 1 1 2 3\nparm u 0 1\nend\n\tf\t1  2\t3 \t # the only face\r\n"
    );
    let model = read(&text).unwrap();
    assert_eq!(model.triangles, [[0, 1, 2]]);
    assert_eq!(model.warnings, []);
}

#[test]
fn positions_with_weight_and_colour() {
    // x y z; x y z w; x y z r g b; x y z r g b a: the weight and the alpha mean nothing here.
    let text = "v 1 2 3\nv 1 2 3 0.5\nv 1 2 3 .25 .5 .75\nv 1 2 3 .25 .5 .75 0\nf 1 2 3 4";
    let model = read(text).unwrap();
    assert!(model.vertices.iter().all(|v| v.position == [1.0, 2.0, 3.0]));
    let colours: Vec<_> = model.vertices.iter().map(|v| v.colour).collect();
    assert_eq!(colours[..2], [[1.0; 3]; 2]);
    assert_eq!(colours[2..], [[0.25, 0.5, 0.75]; 2]);
}

#[test]
fn texture_places_of_one_two_and_three_numbers() {
    let model = read(&format!(
        "{CORNERS}vt .5\nvt .5 .25\nvt .5 .25 9\nf 1/1 2/2 3/3"
    ));
    let uvs: Vec<_> = model.unwrap().vertices.iter().map(|v| v.uv).collect();
    assert_eq!(uvs, [[0.5, 0.0], [0.5, 0.25], [0.5, 0.25]]);
}

#[test]
fn bytes_that_are_not_utf8_may_stand_in_comments_and_names() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("latin.obj");
    let load = |text: &[u8]| {
        std::fs::write(&path, text).unwrap();
        Model::load(&path)
    };
    std::fs::write(folder.path().join("x.mtl"), b"newmtl caf\xe9\nKd 0 0 1\n").unwrap();
    let text = b"# caf\xe9\nmtllib x.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl caf\xe9\nf 1 2 3\n";
    let model = load(text).unwrap();
    assert_eq!(model.vertices[0].colour, [0.0, 0.0, 1.0]);
    assert!(model.warnings.is_empty());
    for text in [&b"v 0 0 0\nv 0 0 \xe9\n"[..], b"\nf\xff 1 2 3\n"] {
        assert_eq!(load(text).unwrap_err().line, Some(2));
    }
}

/// A xorshift generator, so that the cases are the same everywhere.
fn next(state: &mut u64) -> usize {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 33) as usize
}

#[test]
fn random_damage_never_panics_and_never_lets_a_bad_value_in() {
    const BASE: &str = "v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 -1e3\nv 1 1 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf -1 -2 -3 -4\n";
    const PIECES: [&str; 14] = [
        "/",
        "-",
        "9",
        "\n",
        " ",
        "f ",
        "v ",
        "nan",
        "e99",
        "\\\n",
        "#",
        "\u{0}",
        "é",
        "-9223372036854775808",
    ];
    let mut state = 0x1234_5678_9abc_def1;
    let mut accepted = 0;
    for _ in 0..20_000 {
        let mut bytes = BASE.as_bytes().to_vec();
        for _ in 0..1 + next(&mut state) % 4 {
            let from = next(&mut state) % bytes.len();
            let to = (from + next(&mut state) % 3).min(bytes.len());
            let piece = PIECES[next(&mut state) % PIECES.len()];
            bytes.splice(from..to, piece.bytes());
        }
        bytes.truncate(bytes.len() - next(&mut state) % 6);
        let Ok(model) = read(&String::from_utf8_lossy(&bytes)) else {
            continue;
        };
        accepted += 1;
        let count = model.vertices.len() as u32;
        assert!(model.triangles.iter().flatten().all(|&index| index < count));
        assert_eq!(model.triangles.len(), model.triangle_materials.len());
        for v in &model.vertices {
            assert!(
                v.position
                    .iter()
                    .chain(&v.normal)
                    .chain(&v.uv)
                    .all(|x| x.is_finite())
            );
            assert!(v.colour.iter().all(|c| (0.0..=1.0).contains(c)));
        }
    }
    assert!(
        accepted > 400,
        "the damage must leave some files whole: {accepted}"
    );
}

/// On a well-formed file `tobj`, an independent reader, finds the same corners.
#[test]
fn agrees_with_tobj() {
    let mut text = String::new();
    for i in 0..40 {
        let (x, y) = (f64::from(i % 8), f64::from(i / 8));
        text += &format!(
            "v {x} {y} {} {} {} 0.5\nvt {} {}\nvn {x} {y} 1\n",
            x * y,
            x / 8.0,
            y / 8.0,
            x / 8.0,
            y / 8.0
        );
    }
    for i in 0..31 {
        let (a, b, c, d) = (i + 1, i + 2, i + 10, i + 9);
        text += &format!("f {a}/{b}/{c} {b}/{c}/{d} {c}/{d}/{a} {d}/{a}/{b}\n");
        text += &format!("f -{a}/-{b}/-{c} -{b}/-{c}/-{d} -{c}/-{d}/-{a}\n");
    }
    let ours = read(&text).unwrap();
    let (models, _) = tobj::load_obj_buf(
        &mut text.as_bytes(),
        &tobj::LoadOptions {
            triangulate: true,
            single_index: true,
            ..Default::default()
        },
        |_| Err(tobj::LoadError::GenericFailure),
    )
    .unwrap();
    let theirs = &models[0].mesh;
    assert_eq!(ours.triangles.as_flattened().len(), theirs.indices.len());
    for (&our_index, &their_index) in ours.triangles.as_flattened().iter().zip(&theirs.indices) {
        let vertex = &ours.vertices[our_index as usize];
        let at = their_index as usize;
        assert_eq!(vertex.position, theirs.positions[at * 3..][..3]);
        assert_eq!(vertex.colour, theirs.vertex_color[at * 3..][..3]);
        assert_eq!(vertex.uv, theirs.texcoords[at * 2..][..2]);
        let normal = unit(theirs.normals[at * 3..][..3].try_into().unwrap());
        for (got, want) in vertex.normal.into_iter().zip(normal) {
            assert!((got - want).abs() < 1e-15, "{vertex:?}");
        }
    }
}
