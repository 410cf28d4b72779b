//! Where instructions go.

use host_tests::firmware::profile::*;
use host_tests::firmware::{FirmwareError, Symbol};

#[test]
fn only_what_lies_between_the_marks_is_counted() {
    let mut counter = Counter {
        begin: 0x10,
        end: 0x20,
        counts: Counts::default(),
        is_on: false,
    };
    let log = "Trace 0: 0x7f [00800408/00000008/00000110/ff000201] before\n\
         Trace 0: 0x7f [00800408/00000010/00000110/ff000201] scanbeam_profile_begin\n\
         Trace 0: 0x7f [00800408/00000012/00000110/ff000201] scanbeam_profile_begin\n\
         Linking TBs 0x7f\n\
         Trace 0: 0x7f [00800408/00000008/00000110/ff000201] draw\n\
         Trace 0: 0x7f [00800408/00000008/00000110/ff000201] draw\n\
         Trace 0: 0x7f [00800408/00000020/00000110/ff000201] scanbeam_profile_end\n\
         Trace 0: 0x7f [00800408/00000008/00000110/ff000201] after\n";
    log.split_inclusive('\n')
        .filter_map(|line| address_of(line.as_bytes()))
        .for_each(|address| counter.step(address));
    let counts = counter.counts;
    assert_eq!((counts.at(8), counts.at(0x12), counts.all()), (2, 1, 3));
    let draw = Symbol {
        address: 6,
        bytes: 6,
        name: "draw".into(),
    };
    assert_eq!(counts.of(&draw), 2);
}

#[test]
fn a_listing_has_counts_before_its_instructions() {
    let mut counts = Counts::default();
    (0..3).for_each(|_| counts.add(0x24d1e));
    let listing = "\nfw:     file format elf32\n\n00024d1c <draw>:\n   24d1c:\tpush\t{r4, lr}\n   24d1e:\tnop\n";
    assert_eq!(
        annotated(listing, &counts),
        "           24d1c push {r4, lr}\n        3  24d1e nop\n"
    );
}

#[test]
fn a_frame_is_one_word() {
    for name in ["", "a b", "a,arg=b", "../a"] {
        let error = check_name(name);
        assert!(
            matches!(error, Err(FirmwareError::NoFrame { .. })),
            "{name:?}"
        );
    }
}
