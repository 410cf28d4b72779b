//! The mock forgives nothing, so that what the pump does wrong is seen.

use super::{FULL, Mock, mock};
use host_tests::mock::{HostLine, MockError};
use scanbeam::scan_out::{ErrorKind, ScanoutDma, Window};
use std::task::Poll;

#[test]
fn the_mock_refuses_misuse_and_says_where() {
    let refused = |act: fn(&mut Mock) -> std::result::Result<(), MockError>, kind, line| {
        let mut mock = mock().late_by(1);
        let error = act(&mut mock).unwrap_err();
        assert_eq!((error.kind, error.line), (kind, line), "{error}");
    };
    pub(super) fn start(mock: &mut Mock, words: usize) -> std::result::Result<(), MockError> {
        mock.start(HostLine::new(12), words)
            .map_err(|(error, buf)| {
                assert_eq!(buf, HostLine::new(12), "the buffer comes back");
                error
            })
    }
    pub(super) fn wait(mock: &mut Mock) {
        while !matches!(mock.poll(), Poll::Ready(Ok(None))) {}
    }
    fn lines(y: u16, height: u16) -> Window {
        Window { y, height, ..FULL }
    }
    fn after_the_second(m: &mut Mock, next: Window) -> std::result::Result<(), MockError> {
        m.begin(lines(2, 1))?;
        start(m, 6)?;
        wait(m);
        m.end()?;
        m.begin(next)
    }
    use ErrorKind::{Length, Sequence};

    refused(|m| start(m, 6), Sequence, 0); // no begin
    refused(|m| m.begin(Window { height: 8, ..FULL }), Length, 0);
    refused(|m| m.begin(Window { width: 0, ..FULL }), Length, 0);
    refused(
        |m| {
            m.begin(Window {
                x: u16::MAX,
                y: 3,
                width: 2,
                height: 1,
            })
        },
        Length,
        3,
    );
    refused(|m| m.begin(FULL).and_then(|()| m.begin(FULL)), Sequence, 0);
    refused(|m| m.begin(FULL).and_then(|()| m.end()), Sequence, 0); // all lines missing
    for (words, kind) in [(0, Length), (5, Length), (7, Length), (18, Length)] {
        let mut mock = mock();
        mock.begin(FULL).unwrap();
        assert_eq!(start(&mut mock, words).unwrap_err().kind, kind);
    }
    let busy = |m: &mut Mock| {
        m.begin(FULL)?;
        start(m, 12)?;
        start(m, 6)
    };
    refused(busy, Sequence, 2);
    refused(
        |m| {
            m.begin(FULL)
                .and_then(|()| start(m, 6))
                .and_then(|()| m.end())
        },
        Sequence,
        1,
    );
    let missing = |m: &mut Mock| {
        m.begin(FULL)?;
        start(m, 12)?;
        wait(m);
        m.end()
    };
    refused(missing, Sequence, 2);
    let too_many = |m: &mut Mock| {
        m.begin(lines(2, 1))?;
        start(m, 12)
    };
    refused(too_many, Sequence, 2);
    refused(|m| after_the_second(m, lines(2, 2)), Sequence, 2);
    refused(|m| after_the_second(m, lines(1, 1)), Sequence, 1);

    // Two at once, and no third, when it chains.
    let mut chain = mock().late_by(1).chained();
    chain.begin(FULL).unwrap();
    start(&mut chain, 6).unwrap();
    start(&mut chain, 6).unwrap();
    assert_eq!(start(&mut chain, 6).unwrap_err().kind, Sequence);
}
