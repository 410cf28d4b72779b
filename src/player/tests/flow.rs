//! Counts, positions, and what goes on with what.

use super::*;

/// Kills: words that were passed over are added without a look at how many there are already.
#[test]
fn counts_stay_at_the_largest_number() {
    let passed = 16 << 16;
    let mut list = behind(passed);
    for _ in 0..16 {
        list.push(block(8, 65_535, 0));
        list.resize(list.len() + 65_535, 0);
    }
    list.extend([flow(5), 0]);
    let list = listed(&list);
    let mut player = player(PlayerSettings::default(), Lent::SOME);
    drawn(|scene| {
        let mut budget = Budget {
            instructions: 17 + 2 * 4_099,
            vertices: 0,
            jumps: u32::MAX,
        };
        let said = player.run(list, scene, &mut budget, &mut |_: Notice| {});
        assert_eq!(said, Ok(Halt::Budget));
    });
    let counts = player.counts();
    assert!(counts.skipped > 4_096 && counts.skipped_words == u32::MAX);
}
