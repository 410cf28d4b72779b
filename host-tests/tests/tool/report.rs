//! The report as a page.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use host_tests::report::effects::effects;
use host_tests::report::paced::paced;
use host_tests::report::page::{Page, escaped, marked_up};
use host_tests::report::scene_files::{files, scene_files};
use host_tests::report::{cache, errors, memory, shots};

/// The values of an attribute.
fn values<'p>(page: &'p str, attribute: &str) -> Vec<&'p str> {
    let start = format!("{attribute}=\"");
    let rest = page.split(&start).skip(1);
    rest.filter_map(|rest| rest.split('"').next()).collect()
}

#[test]
fn text_is_escaped() {
    assert_eq!(escaped("a < b & \"c\""), "a &lt; b &amp; &quot;c&quot;");
    let code = "a `b < c` d `e`";
    assert_eq!(marked_up(code), "a <code>b &lt; c</code> d <code>e</code>");
    assert_eq!(marked_up("a ` b"), "a ` b");
}

/// Every picture is in the page and can be decoded; nothing is asked of another file.
#[test]
fn no_picture_is_missing() {
    let mut page = Page::new("test");
    shots(&mut page).unwrap();
    errors(&mut page).unwrap();
    effects(&mut page).unwrap();
    scene_files(&mut page).unwrap();
    paced(&mut page).unwrap();
    cache(&mut page).unwrap();
    memory(&mut page);
    let page = page.finish();
    let sources = values(&page, " src");
    // 8 shots, 4 of scene B, 5 more of the suite, 6 pictures with their errors, 4 effects, 2 small frames, 21 by draw calls,
    // the scene files, each named, and 8 frames that are paced, beside the same with time enough.
    assert_eq!(sources.len(), 8 + 4 + 5 + 12 + 4 + 2 + 21 + 5 + 16);
    for file in files().unwrap() {
        let name = file.file_name().unwrap().to_str().unwrap();
        assert!(page.contains(&format!("<code>{name}</code>: ")), "{name}");
    }
    for source in sources {
        let data = source.strip_prefix("data:image/png;base64,").unwrap();
        let png = STANDARD.decode(data).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(png))
            .read_info()
            .unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        assert!(
            pixels.iter().any(|&level| level != pixels[0]),
            "a picture of one colour"
        );
    }
    // A plot without a size of its own has none in a box that is as wide as what is in it.
    assert!(page.contains("figure.plot{width:"));
    assert_eq!(page.matches("<svg").count(), 3);
    assert_eq!(page.matches("</svg>").count(), 3);
    for link in values(&page, "href") {
        let id = link.strip_prefix('#').expect("no other page is linked");
        assert!(page.contains(&format!("id=\"{id}\"")), "{link}");
    }
}
