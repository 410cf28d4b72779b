//! `view` on a pseudo-terminal: what would be seen there, at every key and size, and that the
//! terminal is as it was whatever ends it.
//!
//! What arrives is shown by an emulated terminal. Nothing is timed: each step waits until it sees
//! what it expects, and gives up after a minute.

use rustix::process::{Pid, Signal, kill_process};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{LocalModes, Termios, Winsize, tcgetattr, tcsetwinsize};
use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::os::unix::process::ExitStatusExt;
use std::process::{Child, Command, ExitStatus};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};
use vt100::{Color, Parser};

const PATIENCE: Duration = Duration::from_secs(60);
/// Longer than a stopped model waits before it looks about.
const QUIET: Duration = Duration::from_millis(400);

/// A terminal with `view` on it.
struct Terminal {
    keys: File,
    /// The program's end, kept so that it can be asked about afterwards.
    line: File,
    before: Termios,
    received: Receiver<Vec<u8>>,
    shown: Parser,
    child: Child,
}

impl Terminal {
    /// Starts `view` with these words on so many rows and columns.
    fn start(words: &[&str], (rows, columns): (u16, u16), colorterm: &str) -> Self {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&master).unwrap();
        unlockpt(&master).unwrap();
        let name = ptsname(&master, Vec::new()).unwrap().into_string().unwrap();
        let line = OpenOptions::new()
            .read(true)
            .write(true)
            .open(name)
            .unwrap();
        let before = tcgetattr(&line).unwrap();
        let mut from = File::from(master);
        let keys = from.try_clone().unwrap();
        let (to, received) = channel();
        thread::spawn(move || {
            let mut bytes = [0; 65536];
            while let Ok(count @ 1..) = from.read(&mut bytes) {
                if to.send(bytes[..count].to_vec()).is_err() {
                    break;
                }
            }
        });
        let end = || line.try_clone().unwrap();
        set_size(&line, rows, columns);
        // A session of its own, so that this is its terminal and not that of who runs the tests.
        let child = Command::new("setsid")
            .args(["--ctty", env!("CARGO_BIN_EXE_scanbeam"), "view"])
            .args(words)
            .env("TERM", "xterm-256color")
            .env("COLORTERM", colorterm)
            .stdin(end())
            .stdout(end())
            .stderr(end())
            .spawn()
            .unwrap();
        Self {
            keys,
            line,
            before,
            received,
            shown: Parser::new(rows, columns, 0),
            child,
        }
    }

    fn resize(&mut self, rows: u16, columns: u16) {
        self.shown.screen_mut().set_size(rows, columns);
        set_size(&self.line, rows, columns);
    }

    fn press(&mut self, keys: &str) {
        self.keys.write_all(keys.as_bytes()).unwrap();
    }

    fn text(&self) -> String {
        self.shown.screen().contents()
    }

    /// Reads on until the screen is as it should be.
    fn wait(&mut self, what: &str, seen: impl Fn(&Self) -> bool) {
        let end = Instant::now() + PATIENCE;
        while !seen(self) {
            let rest = end.saturating_duration_since(Instant::now());
            match self.received.recv_timeout(rest) {
                Ok(bytes) => self.shown.process(&bytes),
                Err(error) => panic!("{what}: {error}, on the screen:\n{}", self.text()),
            }
        }
    }

    fn wait_for(&mut self, text: &str) {
        self.wait(text, |terminal| terminal.text().contains(text));
    }

    /// Presses a key, and waits for text.
    fn press_for(&mut self, key: &str, text: &str) {
        self.press(key);
        self.wait_for(text);
    }

    /// Reads on until nothing comes.
    fn settle(&mut self) {
        loop {
            match self.received.recv_timeout(QUIET) {
                Ok(bytes) => self.shown.process(&bytes),
                Err(RecvTimeoutError::Timeout) => return,
                Err(error) => panic!("{error}"),
            }
        }
    }

    /// Rows of the picture, from the top: those that are half blocks from end to end.
    fn picture(&self) -> Vec<Vec<(Color, Color)>> {
        let screen = self.shown.screen();
        let (rows, columns) = screen.size();
        let row = |row| -> Option<Vec<(Color, Color)>> {
            let cells = (0..columns).map(|column| screen.cell(row, column));
            cells
                .map(|cell| cell.filter(|cell| cell.contents() == "\u{2580}"))
                .map(|cell| cell.map(|cell| (cell.fgcolor(), cell.bgcolor())))
                .collect()
        };
        (0..rows).map_while(row).collect()
    }

    /// Whether all rows above the text are the picture's.
    fn is_full(&self) -> bool {
        let (rows, _) = self.shown.screen().size();
        let text = self.text();
        let keys = text.lines().position(|line| line.starts_with("Esc end"));
        let figures = text
            .lines()
            .position(|line| line.contains("frames a second"));
        let picture = self.picture().len();
        figures.or(keys) == Some(picture) && text.lines().count() == usize::from(rows)
    }

    /// Waits for the end, which must leave the terminal as it was.
    fn end(mut self) -> ExitStatus {
        let status = self.child.wait().unwrap();
        self.settle();
        let after = tcgetattr(&self.line).unwrap();
        assert_eq!(after.local_modes, self.before.local_modes);
        assert_eq!(after.input_modes, self.before.input_modes);
        assert_eq!(after.output_modes, self.before.output_modes);
        assert!(!self.shown.screen().alternate_screen());
        assert!(!self.shown.screen().hide_cursor());
        assert!(!self.text().contains('\u{2580}'), "{}", self.text());
        status
    }
}

fn set_size(line: &File, rows: u16, columns: u16) {
    let size = Winsize {
        ws_row: rows,
        ws_col: columns,
        ws_xpixel: 0,
        ws_ypixel: 0,
    };
    tcsetwinsize(line, size).unwrap();
}

#[test]
fn keys_and_sizes_are_followed() {
    let mut terminal = Terminal::start(&[], (24, 80), "truecolor");
    terminal.wait("a frame", Terminal::is_full);
    let modes = tcgetattr(&terminal.line).unwrap().local_modes;
    assert!(!modes.intersects(LocalModes::ICANON | LocalModes::ECHO));
    let screen = terminal.shown.screen();
    assert!(screen.alternate_screen() && screen.hide_cursor());
    // It turns by itself, and what is drawn and left out is said.
    let first = terminal.picture();
    terminal.wait("a turn", |terminal| terminal.picture() != first);
    terminal.wait_for("triangles left out");
    let is_rgb = |colour| matches!(colour, Color::Rgb(..));
    let cells = terminal.picture().concat();
    assert!(cells.iter().all(|&(a, b)| is_rgb(a) && is_rgb(b)));

    for (key, said) in [
        ("q", "exact"),
        ("q", "fast"),
        ("s", "none"),
        ("s", "flat"),
        ("c", "224 slots"),
        ("r", "2 renderers"),
        ("F", "rgb888"),
    ] {
        terminal.press_for(key, said);
    }
    // Stopped, it sends nothing; each key that moves the eye changes the picture.
    terminal.press(" ");
    terminal.settle();
    for key in ["\x1b[A", "\x1b[B", "\x1b[C", "\x1b[D", "+", "-"] {
        let before = terminal.picture();
        terminal.press(key);
        terminal.wait(key, |terminal| terminal.picture() != before);
        terminal.settle();
    }
    // Wider, narrower, and hardly a terminal: the picture has all rows that the text leaves.
    for (rows, columns) in [(40, 133), (12, 40), (6, 20), (3, 9), (24, 80)] {
        terminal.resize(rows, columns);
        terminal.wait("another size", Terminal::is_full);
        terminal.settle();
        assert!(terminal.is_full(), "{rows} rows: {}", terminal.text());
    }
    terminal.press("\x1b");
    assert!(terminal.end().success());
}

#[test]
fn whatever_ends_it_leaves_the_terminal_as_it_was() {
    // 256 colours where the terminal says no more, and a picture smaller than the terminal.
    let small = ["--size", "10x8"];
    let mut terminal = Terminal::start(&small, (24, 100), "");
    terminal.wait_for("Esc end");
    let cell = terminal.shown.screen().cell(1, 5).unwrap();
    assert!(matches!(cell.fgcolor(), Color::Idx(16..)), "{cell:?}");
    for (row, column) in [(1, 10), (4, 0)] {
        let cell = terminal.shown.screen().cell(row, column).unwrap();
        assert!(!cell.has_contents());
    }
    // Control and C.
    terminal.press("\x03");
    assert!(terminal.end().success());

    let mut terminal = Terminal::start(&[], (24, 80), "truecolor");
    terminal.wait_for("Esc end");
    let child = Pid::from_child(&terminal.child);
    kill_process(child, Signal::TERM).unwrap();
    assert_eq!(terminal.end().signal(), Some(Signal::TERM.as_raw()));

    let mut terminal = Terminal::start(&[], (24, 80), "truecolor");
    terminal.wait_for("Esc end");
    terminal.press("x");
    assert!(terminal.end().success());
}
