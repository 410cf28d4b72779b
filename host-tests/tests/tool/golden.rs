//! The record of golden pictures.

use host_tests::golden::*;

fn pictures(of: &[(&str, u32)]) -> Pictures {
    of.iter()
        .map(|(name, crc)| ((*name).to_owned(), *crc))
        .collect()
}

#[test]
fn each_picture_that_differs_is_named_and_a_blessing_fails() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("golden.txt");
    let old = pictures(&[("frame a", 1), ("frame b", 0xFFFF_FFFF), ("render c d", 3)]);
    let told = |drawn: &Pictures, bless| judge(&path, drawn, bless).unwrap_err().to_string();
    assert!(told(&old, false).contains("No such file"));
    assert!(told(&old, true).contains("is written anew"));
    assert_eq!(read(&path).unwrap(), old);
    judge(&path, &old, false).unwrap();
    let new = pictures(&[("frame a", 2), ("render c d", 3), ("render e", 5)]);
    assert_eq!(
        told(&new, false),
        "pictures differ:\n\
         frame a: 00000002 where 00000001 is recorded\n\
         frame b: is recorded and was not drawn\n\
         render e: is not recorded"
    );
    for wrong in ["00000001 a\n00000002 a\n", "xyz a\n", "00000001\n"] {
        std::fs::write(&path, wrong).unwrap();
        assert!(read(&path).is_err(), "{wrong:?}");
    }
}
