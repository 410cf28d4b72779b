//! The table of textures, and what errors of them mean.

use host_tests::say;
use host_tests::texture_report::*;

#[test]
fn blocks_change_pages_less() {
    say!("{}", texture_table());
    for (name, view) in VIEWS {
        let [rows, blocks] = compare(view);
        assert_eq!(rows.fetches, blocks.fetches);
        assert!(rows.fetches > 20_000, "{name}: {rows:?}");
        if view == View::Quarter || view == View::Turned {
            assert!(rows.page_changes >= 3 * blocks.page_changes, "{name}");
            assert!(rows.re_reads > blocks.re_reads, "{name}");
        }
        if view == View::Sphere || view == View::Ground {
            assert!(rows.page_changes > blocks.page_changes, "{name}");
            assert!(rows.re_reads > blocks.re_reads, "{name}");
        }
    }
}

#[test]
fn strips_change_pages_less_than_lines() {
    let mut state = 1u64;
    let mut below = |n: u64| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (((state >> 33) * n) >> 31) as u16
    };
    for (size, block) in [
        (16, (32, 16)),
        (64, (32, 16)),
        (200, (32, 16)),
        (200, (8, 8)),
    ] {
        let mut sums = [0u64; 3];
        let count = 300;
        for _ in 0..count {
            let base = (below(8 * (320 - size)), below(8 * (240 - size.min(239))));
            let corners = [(); 3].map(|()| (base.0 + below(8 * size), base.1 + below(8 * size)));
            let pages = triangle_pages(corners, (320, 240), block);
            for (sum, pages) in sums.iter_mut().zip(pages) {
                *sum += u64::from(pages);
            }
        }
        let mean = sums.map(|sum| sum as f64 / f64::from(count));
        say!(
            "triangles in boxes of {size} pixels, pages of {}x{}: {:.2} page changes by strips, \
             {:.2} by lines, {:.2} by lines into rows",
            block.0,
            block.1,
            mean[0],
            mean[1],
            mean[2]
        );
        assert!(sums[0] < sums[1] && sums[0] < sums[2], "{mean:?}");
    }
}

#[test]
#[should_panic(expected = "written twice")]
fn a_pixel_is_written_once() {
    let mut frame = BlockFrame::new((4, 4), (2, 2));
    frame.write((1, 1));
    frame.write((1, 1));
}

/// Block-fix falls and rises again at each range, and is above 16 bits of 1/w from the second
/// range on, where it has one bit more, then four, then seven.
#[test]
fn depth_resolution_is_that_of_the_ranges() {
    let chart = depth_resolution();
    let [fix, fixed, wide, linear] = &chart.series[..] else {
        panic!("four formats");
    };
    for (i, w) in (0..=12 * 4).map(|i| (i as usize, 2f64.powf(f64::from(i) / 4.0) * 1.01)) {
        let range = ((w.log2() / 3.0) as u32).min(3);
        // From the definition: 14 bits of significand at a scale of 2^(-3 e).
        let want = (14.0 + 3.0 * f64::from(range) - w.log2()).max(0.0);
        assert!(
            (fix.values[i] - want).abs() < 1e-9,
            "{w}: {}",
            fix.values[i]
        );
        assert!((fixed.values[i] - (16.0 - w.log2()).max(0.0)).abs() < 1e-9);
        assert!(wide.values[i] > fix.values[i]);
        // The two of 32 bits together have 51 bits: what one loses with distance,
        // the other gains.
        assert!((linear.values[i] + wide.values[i] - 51.0).abs() < 1e-3);
        if range > 0 {
            assert!(fix.values[i] > fixed.values[i]);
        }
    }
    let folder = tempfile::tempdir().expect("there is room");
    write_plots(folder.path()).expect("there is room");
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name));
    for name in ["block-fix 16", "32-bit 1/w", "32-bit linear"] {
        let svg = read("depth-resolution.svg").expect("it is there");
        assert!(svg.contains(name), "{name}");
    }
    for (name, chart) in [
        ("depth-resolution.png", chart),
        ("texture-pages.png", texture_pages()),
        ("texture-reads.png", texture_reads()),
    ] {
        let plot = host_tests::image_out::read_image(&folder.path().join(name));
        assert_eq!(plot.expect("it is there"), chart.to_frame());
    }
    // Every count of the table is written in the plots.
    for (name, view) in VIEWS {
        for access in compare(view) {
            for (file, count) in [
                ("texture-pages.svg", access.page_changes),
                ("texture-reads.svg", access.re_reads),
            ] {
                let svg = read(file).expect("it is there");
                assert!(
                    svg.contains(&format!(">{count}<")) && svg.contains(name),
                    "{file}"
                );
            }
        }
    }
}
