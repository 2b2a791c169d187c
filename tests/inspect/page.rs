//! The page of an inspection in a browser.

use crate::chromium::Browser;
use crate::{coarse, inspect};
use tribosweep_output::inspect::{Options, PAGE, PageHeader, write};

/// Protects: the page loads nothing but itself, has no errors, and has all drawings. It is not wider than its window on a
/// desktop and on a phone, and on a desktop its tables do not scroll.
#[test]
fn the_page_is_complete() {
    let Some(mut browser) = Browser::start() else { return };
    let inspection = inspect(&coarse(), &Options::default());
    let folder = tempfile::tempdir().unwrap();
    write(
        &inspection,
        folder.path(),
        &PageHeader { title: "<b>mine</b>".to_owned(), ..PageHeader::default() },
    )
    .unwrap();
    let page = folder.path().canonicalize().unwrap().join(PAGE);
    for (width, is_phone) in [(390, true), (1200, false)] {
        browser.resize(width, 900, is_phone);
        browser.open(&page);
        let overflow = browser.evaluate("Math.max(0, document.documentElement.scrollWidth - innerWidth)");
        assert_eq!(overflow, 0, "{width} px");
        if !is_phone {
            let script = "[...document.querySelectorAll('.scroll:has(table)')].filter(box => box.scrollWidth > box.clientWidth).length";
            assert_eq!(browser.evaluate(script), 0, "tables that are cut");
        }
        assert_eq!(browser.evaluate("document.querySelectorAll('figure > svg').length"), 10);
        assert_eq!(browser.evaluate("document.querySelector('h1').textContent"), "<b>mine</b>");
    }
    assert!(browser.complaints().is_empty(), "{:?}", browser.complaints());
    let requests = browser.requests();
    assert!(
        requests.iter().all(|url| url.starts_with("file://") || url.starts_with("data:")),
        "{requests:?}"
    );
}
