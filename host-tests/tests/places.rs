//! Places on a texture as the tool measures them.

use host_tests::places::Shown;

/// Kills: a distance to the middle of a step, repeats that count, a step that is taken for a texel.
#[test]
fn places_are_off_by_what_is_beyond_their_step() {
    let shown = Shown::Texel {
        place: [8, 1023],
        side: 128,
    };
    assert_eq!(shown.off([1.0, 127.95]), Some([0.0, 0.0]));
    assert_eq!(shown.off([1.25, 128.5]), Some([-0.125, -0.5]));
    assert_eq!(shown.off([129.5, -0.125]), Some([-0.375, 0.0]));
    assert_eq!(shown.off([0.5, 0.0]), Some([0.5, -0.0]));
    assert!(shown.is_texel_of([1.99, 127.0]) && shown.is_texel_of([129.0, -0.1]));
    assert!(!shown.is_texel_of([0.99, 127.0]));
    assert_eq!(Shown::Nothing.off([0.0; 2]), None);
}
