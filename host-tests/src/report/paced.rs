//! Frames whose lines cost no more than they may, beside the same with time enough.

use super::Page;
use crate::frames::paced_frame;
use scenes::PACED;
use std::error::Error;

/// The section.
///
/// # Errors
/// When a frame does not fit the memory that it asks for.
pub fn paced(page: &mut Page) -> Result<(), Box<dyn Error>> {
    page.section("paced", "Lines that cost no more than they may");
    page.paragraph(
        "Left with time enough, right with so little that it is seen what is lost. A line may cost what is said, in \
         instructions on a Cortex-M4, or in M0+ code where the name ends in `m0`.",
    );
    for paced in PACED {
        let frame = paced_frame(paced)?;
        let [unhurried, drawn] = frame.pictures()?;
        let paid = frame.paid;
        let caption = format!(
            "{}: {} a line, of which the dearest was reckoned to take {}; quality was lowered on {} lines, {} pixels are \
             others: {} have the colour of the middle of their run, {} of what is left of it, {} were not compared with all \
             others, {} were left out; {} triangles were late, {} lost",
            paced.name,
            paced.pace.most,
            paid.dearest,
            paid.lines,
            frame.differing(),
            paid.even,
            paid.joined,
            paid.unsorted,
            paid.left_out,
            paid.late,
            paid.lost
        );
        page.pictures(&[&unhurried, &drawn], &caption)?;
    }
    Ok(())
}
