//! A display told to the byte: what a MIPI panel does with what comes over its bus, what a draw target does with
//! colours, and each of them failing when told to.

use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{OriginDimensions, Size};
use embedded_graphics_core::pixelcolor::{IntoStorage, Rgb565};
use embedded_graphics_core::{Pixel, primitives::Rectangle};
use embedded_hal::digital::{self, OutputPin};
use embedded_hal::spi::{self, Operation, SpiDevice};

/// What came over the bus: a command, or data of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Sent {
    Command(u8),
    Data(Vec<u8>),
}

/// A bus, a pin or a target that fails on purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Broken;

impl spi::Error for Broken {
    fn kind(&self) -> spi::ErrorKind {
        spi::ErrorKind::Other
    }
}

impl digital::Error for Broken {
    fn kind(&self) -> digital::ErrorKind {
        digital::ErrorKind::Other
    }
}

/// The display's side.
#[derive(Debug)]
pub struct Glass {
    width: u16,
    height: u16,
    /// Big-endian pixels as numbers; `None` was never written.
    pub shown: Vec<Option<u16>>,
    pub sent: Vec<Sent>,
    is_data: bool,
    columns: (u16, u16),
    lines: (u16, u16),
    /// The next pixel of the window, when memory is written.
    cursor: Option<(u16, u16)>,
    /// Operations so far, of pin, bus and target, and which of them fails.
    pub operations: usize,
    pub fails_at: Option<usize>,
}

/// The display, as all who hold it see it.
pub type Shared = Rc<RefCell<Glass>>;

impl Glass {
    pub fn shared(width: u16, height: u16) -> Shared {
        Rc::new(RefCell::new(Self {
            width,
            height,
            shown: vec![None; usize::from(width) * usize::from(height)],
            sent: Vec::new(),
            is_data: false,
            columns: (0, 0),
            lines: (0, 0),
            cursor: None,
            operations: 0,
            fails_at: None,
        }))
    }

    /// Counts an operation; fails when it is the one.
    fn operate(&mut self) -> Result<(), Broken> {
        let at = self.operations;
        self.operations += 1;
        if self.fails_at == Some(at) {
            Err(Broken)
        } else {
            Ok(())
        }
    }

    /// Lets the operation of that number from now on fail, and counts lines from 0 again.
    pub fn fail_after(&mut self, operations: usize) {
        self.fails_at = Some(self.operations + operations);
        self.cursor = None;
    }

    /// Lines of the window that were written whole.
    pub fn lines_written(&self) -> u16 {
        self.cursor.map_or(0, |(_, y)| y - self.lines.0)
    }

    fn write(&mut self, bytes: &[u8]) {
        if !self.is_data {
            let &[command] = bytes else {
                panic!("a command is a byte")
            };
            self.sent.push(Sent::Command(command));
            self.cursor = (command == 0x2C).then_some((self.columns.0, self.lines.0));
            return;
        }
        let ends = |bytes: &[u8]| {
            let word = |at| u16::from_be_bytes([bytes[at], bytes[at + 1]]);
            (word(0), word(2))
        };
        match self.sent.last() {
            Some(Sent::Command(0x2A)) => self.columns = ends(bytes),
            Some(Sent::Command(0x2B)) => self.lines = ends(bytes),
            _ => {}
        }
        self.sent.push(Sent::Data(bytes.to_vec()));
        if self.cursor.is_some() {
            for pixel in bytes.chunks(2) {
                self.put(u16::from_be_bytes([pixel[0], pixel[1]]));
            }
        }
    }

    /// The next pixel of the window.
    fn put(&mut self, pixel: u16) {
        let (x, y) = self.cursor.expect("memory is written");
        assert!(y <= self.lines.1, "pixels beyond the window");
        assert!(x < self.width && y < self.height, "pixels off the glass");
        self.shown[usize::from(y) * usize::from(self.width) + usize::from(x)] = Some(pixel);
        self.cursor = Some(if x == self.columns.1 {
            (self.columns.0, y + 1)
        } else {
            (x + 1, y)
        });
    }
}

/// The bus of a display, with chip select.
#[derive(Debug, Clone)]
pub struct Bus(pub Shared);

impl spi::ErrorType for Bus {
    type Error = Broken;
}

impl SpiDevice for Bus {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Broken> {
        let mut glass = self.0.borrow_mut();
        glass.operate()?;
        for operation in operations {
            match operation {
                Operation::Write([]) => {}
                Operation::Write(bytes) => glass.write(bytes),
                _ => panic!("a display is only written to"),
            }
        }
        Ok(())
    }
}

/// Its data/command pin.
#[derive(Debug, Clone)]
pub struct Pin(pub Shared);

impl digital::ErrorType for Pin {
    type Error = Broken;
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Broken> {
        self.0.borrow_mut().operate()?;
        self.0.borrow_mut().is_data = false;
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Broken> {
        self.0.borrow_mut().operate()?;
        self.0.borrow_mut().is_data = true;
        Ok(())
    }
}

/// The display as a draw target.
#[derive(Debug, Clone)]
pub struct Target(pub Shared);

impl OriginDimensions for Target {
    fn size(&self) -> Size {
        let glass = self.0.borrow();
        Size::new(glass.width.into(), glass.height.into())
    }
}

impl DrawTarget for Target {
    type Color = Rgb565;
    type Error = Broken;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(&mut self, _: I) -> Result<(), Broken> {
        panic!("scan-out fills rectangles")
    }

    fn fill_contiguous<I: IntoIterator<Item = Rgb565>>(
        &mut self,
        area: &Rectangle,
        colours: I,
    ) -> Result<(), Broken> {
        let mut glass = self.0.borrow_mut();
        glass.operate()?;
        let (x, y) = (area.top_left.x as u16, area.top_left.y as u16);
        glass.columns = (x, x + area.size.width as u16 - 1);
        glass.lines = (0, y + area.size.height as u16 - 1);
        glass.cursor = Some((x, y));
        for colour in colours {
            glass.put(colour.into_storage());
        }
        assert_eq!(
            glass.cursor,
            Some((x, glass.lines.1 + 1)),
            "as many as the area has"
        );
        Ok(())
    }
}

/// Something that cannot fail, for the reset pin and delays of a driver.
#[derive(Debug, Clone, Copy)]
pub struct Nothing;

impl digital::ErrorType for Nothing {
    type Error = Infallible;
}

impl embedded_hal::delay::DelayNs for Nothing {
    fn delay_ns(&mut self, _: u32) {}
}
