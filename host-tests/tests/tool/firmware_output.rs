//! What the firmware prints, read.

use host_tests::firmware::{FrameResult, Output};

fn parse(text: &str) -> Result<Output, String> {
    let lines: Vec<String> = text.lines().map(str::to_owned).collect();
    Output::parse(&lines).map_err(|error| error.to_string())
}

#[test]
fn output_is_read_whole() {
    let output = parse(
        "count name=loop expected=20 counted=21 ok=1\n\
         frame scene=sphere crc=00ab12ff instructions=123456\n\
         unit name=span count=200 instructions=3200\n\
         lines scene=sphere pass_one=9 first=0 costs=1,2\n\
         lines scene=sphere pass_one=9 first=2 costs=3\n\
         growth slots=64 triangles=72 objects=31 pass_one=5 pass_two=6\n\
         figure name=stack_bytes value=704\n\
         done frames=1",
    )
    .expect("as the firmware documents it");
    let frame = FrameResult {
        scene: "sphere".to_owned(),
        crc: 0x00ab_12ff,
        instructions: 123_456,
    };
    assert_eq!(output.frames, [frame]);
    assert_eq!(output.counts[0].counted, 21);
    assert!(output.counts[0].ok);
    assert_eq!(output.units[0].count, 200);
    assert_eq!(output.lines.len(), 1);
    assert_eq!(output.lines[0].costs, [1, 2, 3]);
    assert_eq!(output.growth[0].pass_two, 6);
    assert_eq!(output.figures["stack_bytes"], 704);
}

#[test]
fn damaged_output_is_refused_with_its_line() {
    for (text, number, reason) in [
        ("", 1, "ends without `done`"),
        (
            "frame scene=a crc=1 instructions=2",
            2,
            "ends without `done`",
        ),
        ("done frames=1", 1, "0 frames came"),
        ("done frames=0\ndone frames=0", 2, "comes after `done`"),
        ("frame scene=a crc=1", 1, "no `instructions`"),
        ("frame scene=a crc=1 crc=1", 1, "`crc` is there twice"),
        (
            "frame scene=a crc=x instructions=2",
            1,
            "not a number in base 16",
        ),
        ("frame scene=a crc=123456789 instructions=2", 1, "that fits"),
        (
            "frame scene=a crc=1 instructions=2 b=3",
            1,
            "`b` is not expected",
        ),
        ("frame scene", 1, "`scene` is not key=value"),
        (
            "figure name=a value=1\nfigure name=a value=1",
            2,
            "came before",
        ),
        ("panic at", 1, "`at` is not key=value"),
        ("panics a=1", 1, "no line begins"),
        (
            "lines scene=a pass_one=1 first=16 costs=1",
            1,
            "did not come",
        ),
        (
            "lines scene=a pass_one=1 first=0 costs=1,x",
            1,
            "`costs`: invalid digit",
        ),
        ("", 1, "ends"),
    ] {
        let error = parse(text).expect_err(text);
        assert!(
            error.starts_with(&format!("line {number} ")),
            "{text}: {error}"
        );
        assert!(error.contains(reason), "{text}: {error}");
    }
}
