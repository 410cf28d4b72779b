//! Damages of the column `where`: each makes its row wrong in one thing.

use super::{faults, root, rows};

/// A row, a text in it, and what is there instead.
type Damage = (&'static str, &'static str, &'static str);

/// Names of nothing.
const UNKNOWN: [Damage; 13] = [
    ("K9", "`frame values_shadows`", "`frame values_shadow`"),
    (
        "K9",
        "`frame values_shadows`",
        "`figure small` `text small`",
    ),
    ("K9", "`frame values_shadows`", "`board cellar`"),
    // An example that is a library.
    ("K9", "`frame values_shadows`", "`board spinner`"),
    ("K9", "`render --shadows`", "`render --shadow`"),
    ("K9", "`render --shadows`", "`render --shadows on`"),
    ("K9", "`render --shadows`", "`paint`"),
    // A flag of another command.
    ("K9", "`render --shadows`", "`bake --shadows`"),
    ("K11", "`scene: blend`", "`scene: blends`"),
    ("K11", ": alphas_of_lists_are", ": alphas_of_lists_were"),
    // A function that is no test, a test that is none of lists, a frame that plays none.
    (
        "P5",
        ": what_is_opaque_has_the_blend_of_the_settings",
        ": picture_of",
    ),
    (
        "S6",
        "list_bake.rs: a_baked_model_is_drawn_and_printed",
        "rows.rs: every_row_has_its_code_and_its_tests",
    ),
    ("C1", "lists `frame teapot_list`", "lists `frame teapot`"),
];

/// Parts that are missing, there twice, in another order, without names, or without a reason.
const PARTS: [Damage; 10] = [
    ("K9", "| host; ", "| "),
    ("K9", "| host; ", "| no host: it is hard; "),
    ("K9", "QEMU `frame values_shadows`; ", ""),
    ("K6", "no lists: ", "nothing: "),
    ("K9", "; tool `render --shadows`", ""),
    ("K9", "; tool", "; tool `render`; tool"),
    (
        "K9",
        "host; QEMU `frame values_shadows`",
        "QEMU `frame values_shadows`; host",
    ),
    ("K9", "QEMU `frame values_shadows`", "QEMU"),
    ("K9", "`render --shadows`", "`render --shadows` or so"),
    ("K6", "no lists: the hardware model has it", "no lists"),
];

/// Code of `src` that runs in no emulator.
const NOT_IN_QEMU: [Damage; 2] = [
    (
        "K9",
        "QEMU `frame values_shadows`",
        "no QEMU: shadows are dark",
    ),
    ("K9", "QEMU `frame values_shadows`", "no QEMU: *not yet*"),
];

#[test]
fn each_damage_of_a_row_is_one_fault_of_it() {
    let table = rows();
    let damages = UNKNOWN.iter().chain(&PARTS).chain(&NOT_IN_QEMU);
    for (id, from, to) in damages {
        let begin = format!("| {id} |");
        let row = table.lines().find(|line| line.starts_with(&begin)).unwrap();
        assert!(row.contains(from), "{id}: {from}");
        // This row alone: that all others are missing is left out.
        let of = |row: &str| {
            let mut found = faults(&format!("| row |\n{row}\n"), &root());
            found.retain(|fault| !fault.ends_with(": missing"));
            found
        };
        assert_eq!(of(row), [""; 0]);
        let found = of(&row.replacen(from, to, 1));
        let is_one = found.len() == 1 && found[0].starts_with(&format!("{id}: "));
        assert!(is_one, "{id}, {to}: {found:?}");
    }
}
