//! A virtual ILI9341 in landscape: it keeps what it was told and complains of what a panel would show
//! wrong, or not at all.
//!
//! What it wants is in the data sheet: 5 ms after power-on, a reset or sleep out, and 120 ms from
//! a reset to sleep out; 16 bits a pixel, the display on; and exactly the window's pixels.

use crc32fast::Hasher;

/// Columns.
pub const WIDTH: u16 = 320;
/// Lines.
pub const HEIGHT: u16 = 240;

const RESET: u8 = 0x01;
const SLEEP_OUT: u8 = 0x11;
const DISPLAY_ON: u8 = 0x29;
const COLUMNS: u8 = 0x2A;
const LINES: u8 = 0x2B;
const PIXELS: u8 = 0x2C;
const ORIENTATION: u8 = 0x36;
const PIXEL_FORMAT: u8 = 0x3A;
/// 16 bits a pixel, on both of the panel's interfaces.
const RGB565: u8 = 0x55;
/// Microseconds after which it hears again.
const PAUSE: u64 = 5_000;
/// Microseconds from a reset to sleep out.
const RESET_TO_WAKE: u64 = 120_000;
/// Complaints that are kept.
const MOST_COMPLAINTS: usize = 20;

/// The panel, from power-on.
#[derive(Debug, Default)]
pub struct Panel {
    /// Each command: its code and, but for pixels, its data.
    commands: Vec<Vec<u8>>,
    /// Of the bytes of each whole window.
    frames: Vec<u32>,
    complaints: Vec<String>,
    /// First and last column, first and last line.
    window: [u16; 4],
    /// Bytes that the open window still wants, and the checksum of those that have come.
    open: Option<(u64, Hasher)>,
    format: Option<u8>,
    is_awake: bool,
    is_on: bool,
    /// When the command that comes is sent, where the emulator knows, and when the last reset or
    /// sleep out was.
    now: Option<u64>,
    reset_at: u64,
    deaf_until: u64,
}

impl Panel {
    /// The commands so far, each with its data.
    pub fn commands(&self) -> &[Vec<u8>] {
        &self.commands
    }

    /// The checksums of whole windows.
    pub fn frames(&self) -> &[u32] {
        &self.frames
    }

    /// What was wrong.
    pub fn complaints(&self) -> &[String] {
        &self.complaints
    }

    /// Something is wrong that the panel itself does not see; each is kept once.
    pub fn complain(&mut self, text: impl Into<String>) {
        let text = text.into();
        if self.complaints.len() < MOST_COMPLAINTS && !self.complaints.contains(&text) {
            self.complaints.push(text);
        }
    }

    /// The next command comes so many microseconds after power-on.
    pub fn at(&mut self, micros: u64) {
        self.now = Some(micros);
    }

    /// Bytes with the data/command pin low.
    pub fn codes(&mut self, bytes: &[u8]) {
        for &code in bytes {
            self.close();
            self.hear(code);
            self.commands.push(vec![code]);
            match code {
                RESET => (self.is_awake, self.is_on, self.format) = (false, false, None),
                SLEEP_OUT => self.is_awake = true,
                DISPLAY_ON => self.is_on = true,
                PIXELS => self.open_window(),
                COLUMNS | LINES | ORIENTATION | PIXEL_FORMAT => {}
                _ => self.complain(format!("unknown command {code:02x}")),
            }
        }
    }

    /// Bytes with the data/command pin high.
    pub fn data(&mut self, bytes: &[u8]) {
        let Some((wanted, sum)) = &mut self.open else {
            match self.commands.last_mut() {
                Some(command) => command.extend(bytes),
                None => self.complain("data before any command"),
            }
            return;
        };
        let fits = usize::try_from(*wanted).map_or(bytes.len(), |left| left.min(bytes.len()));
        sum.update(&bytes[..fits]);
        *wanted -= fits as u64;
        if fits < bytes.len() {
            self.complain("pixels beyond the window");
        }
    }

    /// A panel that is fed from memory shows this.
    pub fn show(&mut self, size: [u64; 2], bytes: &[u8]) {
        let [width, height] = size;
        let wanted = [WIDTH, HEIGHT].map(u64::from);
        if size != wanted || bytes.len() as u64 != 2 * width * height {
            let bytes = bytes.len();
            self.complain(format!(
                "a picture of {width} x {height} pixels in {bytes} bytes"
            ));
        }
        self.frames.push(crc32fast::hash(bytes));
    }

    /// No more comes.
    pub fn finish(&mut self) {
        // The window that the emulator stopped at is empty, and no fault.
        let is_fresh = self.open.as_ref().map(|open| open.0) == Some(self.window_bytes());
        if !is_fresh {
            self.close();
        }
    }

    /// The command before is whole.
    fn close(&mut self) {
        if let Some((left, sum)) = self.open.take() {
            match left {
                0 => self.frames.push(sum.finalize()),
                _ if left % 2 != 0 => self.complain("half a pixel"),
                _ => self.complain(format!("a window is short of {} pixels", left / 2)),
            }
            return;
        }
        let Some(command) = self.commands.last().cloned() else {
            return;
        };
        match command[..] {
            [COLUMNS, a, b, c, d] => self.bound(0, [a, b, c, d], WIDTH),
            [LINES, a, b, c, d] => self.bound(2, [a, b, c, d], HEIGHT),
            [PIXEL_FORMAT, format] => self.format = Some(format),
            [RESET | SLEEP_OUT | DISPLAY_ON] | [ORIENTATION, _] => {}
            [code, ..] if is_known(code) => {
                let bytes = command.len() - 1;
                self.complain(format!("command {code:02x} has {bytes} bytes of data"));
            }
            _ => {}
        }
    }

    fn bound(&mut self, at: usize, [a, b, c, d]: [u8; 4], size: u16) {
        let (first, last) = (u16::from_be_bytes([a, b]), u16::from_be_bytes([c, d]));
        if first > last || last >= size {
            self.complain(format!("a window from {first} to {last} of {size}"));
        }
        self.window[at..at + 2].copy_from_slice(&[first, last]);
    }

    fn window_bytes(&self) -> u64 {
        let [left, right, top, bottom] = self.window.map(u64::from);
        2 * (right + 1).saturating_sub(left) * (bottom + 1).saturating_sub(top)
    }

    fn open_window(&mut self) {
        if !self.is_awake {
            self.complain("pixels for a panel that sleeps");
        }
        if !self.is_on {
            self.complain("pixels for a panel that is switched off");
        }
        if self.format != Some(RGB565) {
            self.complain("pixels for a panel that was not told their format");
        }
        self.open = Some((self.window_bytes(), Hasher::new()));
    }

    /// Whether a command comes too early.
    fn hear(&mut self, code: u8) {
        let Some(now) = self.now else { return };
        let is_deaf = now < self.deaf_until.max(PAUSE);
        if is_deaf || code == SLEEP_OUT && now < self.reset_at + RESET_TO_WAKE {
            self.complain(format!("command {code:02x} comes too early"));
        }
        if matches!(code, RESET | SLEEP_OUT) {
            self.deaf_until = now + PAUSE;
        }
        if code == RESET {
            self.reset_at = now;
        }
    }
}

fn is_known(code: u8) -> bool {
    matches!(
        code,
        RESET | SLEEP_OUT | DISPLAY_ON | COLUMNS | LINES | ORIENTATION | PIXEL_FORMAT
    )
}
