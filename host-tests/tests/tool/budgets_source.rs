//! Counts of the source.

use host_tests::budgets::source::*;
use std::path::PathBuf;

fn counted(sources: &[(&str, &str)]) -> Counts {
    let owned: Vec<(PathBuf, String)> = sources
        .iter()
        .map(|(path, text)| (PathBuf::from(path), (*text).to_owned()))
        .collect();
    count_sources(&owned)
}

#[test]
fn comments_tests_and_strings_are_no_code() {
    let counts = counted(&[
        (
            "src/lib.rs",
            "//! Words.\n\n/* fn a() { /* nested */ } */\nfn a() -> &'static str {\n    // trait X\n    \"trait Y {\\\" // \"\n}\n\
             #[cfg(test)]\n#[allow(dead_code)]\nmod tests {\n    trait Z {}\n}\n#[cfg(test)]\nmod far;\n#[cfg(not(test))]\nfn b(c: char) { let _ = ('{', '\\'', r#\"}\"#); }\n",
        ),
        ("src/far.rs", "trait Q {}\n"),
        ("src/far/deep.rs", "trait Q {}\n"),
    ]);
    // Three lines of `a`, and two of `b`.
    assert_eq!((counts.code_lines, counts.traits), (5, 0), "{counts:?}");
}

#[test]
fn traits_constants_values_and_tuples_are_counted() {
    let text = "pub(crate) trait A<T: Fn(u8) -> u8>: B { const X: bool; const N: usize; const Y: bool = true; }\n\
         impl A for C { const X: bool = false; }\n\
         fn few(a: u8, (b, c): (u8, [u8; 2]), d: &(u8,)) {}\n\
         fn many<F: Fn((u8, u8)) -> bool>(&mut self, (a, (b, c)): (u8, (u8, u8)), f: F, x: &mut (u8, u8, u8), y: A<u8, u8>) {}\n\
         pub struct Two<'a, S, D = Packed<u8, u8>>(S, D);\n";
    let counts = counted(&[("src/x.rs", text)]);
    assert_eq!((counts.traits, counts.bools), (1, 2));
    assert_eq!((counts.tuple_functions, counts.wide_functions), (2, 1));
}

#[test]
fn names_are_those_that_a_user_can_write() {
    let counts = counted(&[
        (
            "src/lib.rs",
            "mod a;\npub mod list;\npub use a::{texture, b::{C, D as E}};\npub use self::F;\npub(crate) use a::G;\npub fn h() { pub struct I; }\npub const J: u8 = 1;\n",
        ),
        ("src/a/mod.rs", "pub struct Hidden;\n"),
        (
            "src/a/texture/mod.rs",
            "pub use x::{K, L};\npub trait M { fn n(); }\n",
        ),
        ("src/list/mod.rs", "pub use x::O;\n"),
        ("src/a/list/mod.rs", "pub use x::{P, Q};\n"),
    ]);
    // list, texture, C, E, F, h, J; and K, L, M, O.
    assert_eq!((counts.root_names, counts.names), (7, 11));
}

#[test]
fn long_files_are_those_above_the_limit() {
    let lines = |count: usize| "// a line\n".repeat(count);
    let (at, above) = (lines(LONG_FILE), lines(LONG_FILE + 1));
    let counts = counted(&[("src/a.rs", &at), ("src/b.rs", &above)]);
    assert_eq!(counts.long_files, 1);
}
