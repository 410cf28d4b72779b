//! Errors are told in the same words everywhere.

use host_support::stdio::reason;
use std::io;
use std::path::Path;

#[test]
fn a_missing_file_is_told_in_the_same_words_everywhere() {
    let missing = Path::new("there/is/no/such/folder/file.png");
    let opened = std::fs::File::open(missing).unwrap_err();
    let staged = tempfile::Builder::new()
        .tempfile_in(missing)
        .map(drop)
        .unwrap_err();
    assert_eq!(reason(&opened), "No such file or directory");
    assert_eq!(reason(&staged), "No such file or directory");
    assert_eq!(reason(&io::Error::other("made up")), "made up");
}
