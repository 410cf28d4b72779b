//! What an emulator prints of a board, line by line: see `host-tests/boards/wire.mjs`.

/// A line of it.
#[derive(Debug, Clone, PartialEq)]
pub enum Event {
    /// The command that follows arrived so many microseconds after the board's start.
    Time(u64),
    /// Bytes have arrived: with the data/command pin high, or low.
    Data {
        /// The pin was high.
        is_data: bool,
        /// In the order of the wire.
        bytes: Vec<u8>,
    },
    /// What a memory-mapped panel shows from now on.
    Picture {
        /// Columns and lines.
        size: [u64; 2],
        /// As on a wire.
        bytes: Vec<u8>,
    },
    /// What was spent until now; the pixels of a frame are about to come.
    Figures(Figures),
    /// The processor's clock, in Hz.
    Clock(u64),
    /// The clock of the bus to the panel, in Hz.
    Bus(u64),
    /// The most bytes that core 0's stack had.
    Stack(u64),
    /// Divisions of all cores, by the chip's divider.
    Divisions(u64),
    /// How often what lies at an address was wanted, all in all.
    Use(Use),
    /// What a chip would not forgive.
    Fault(String),
    /// For the reader.
    Note(String),
    /// The last line; [`FRAMES`] when all frames have come.
    End(String),
}

/// How a run ends that was not cut short.
pub const FRAMES: &str = "frames";

/// Cycles of the processor's clock since the start.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Figures {
    /// All.
    pub cycles: u64,
    /// Of these, the bus to the panel was busy.
    pub bus: u64,
    /// Cores waited, theirs added up.
    pub wait: u64,
    /// Misses of the flash's cache: a number, not cycles.
    pub misses: u64,
}

/// What was read at an address.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Use {
    /// Of the chip.
    pub address: u64,
    /// How often it was not in the flash's cache.
    pub misses: u64,
    /// Periods in which it was read first of its line of the cache.
    pub returns: u64,
}

/// Reads a line.
///
/// # Errors
/// What is wrong with it.
pub fn parse(line: &str) -> Result<Event, String> {
    let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
    let number = |text: &str| {
        text.parse::<u64>()
            .map_err(|_| format!("`{text}` in `{line}`"))
    };
    match word {
        "time" => number(rest).map(Event::Time),
        "clock" => number(rest).map(Event::Clock),
        "bus" => number(rest).map(Event::Bus),
        "stack" => number(rest).map(Event::Stack),
        "divisions" => number(rest).map(Event::Divisions),
        "figures" => {
            let fields = rest.split(' ').map(number).collect::<Result<Vec<_>, _>>()?;
            let [cycles, bus, wait, misses] = fields[..] else {
                return Err(format!("`{line}` has other than four figures"));
            };
            Ok(Event::Figures(Figures {
                cycles,
                bus,
                wait,
                misses,
            }))
        }
        "use" => {
            let fields = rest.split(' ').map(number).collect::<Result<Vec<_>, _>>()?;
            let [address, misses, returns] = fields[..] else {
                return Err(format!("`{line}` has other than three figures"));
            };
            Ok(Event::Use(Use {
                address,
                misses,
                returns,
            }))
        }
        "data" => match rest.split_once(' ') {
            Some((level @ ("0" | "1"), digits)) => Ok(Event::Data {
                is_data: level == "1",
                bytes: from_hex(digits).ok_or_else(|| format!("`{line}` is not in hex"))?,
            }),
            _ => Err(format!("`{line}` has no level of the pin")),
        },
        "picture" => {
            let fields: Vec<&str> = rest.split(' ').collect();
            let [width, height, digits] = fields[..] else {
                return Err("a picture without size or bytes".into());
            };
            Ok(Event::Picture {
                size: [number(width)?, number(height)?],
                bytes: from_hex(digits).ok_or("a picture that is not in hex")?,
            })
        }
        "fault" => Ok(Event::Fault(rest.to_owned())),
        "note" => Ok(Event::Note(rest.to_owned())),
        "end" => Ok(Event::End(rest.to_owned())),
        _ => Err(format!("`{line}` begins with an unknown word")),
    }
}

fn from_hex(digits: &str) -> Option<Vec<u8>> {
    let digit = |byte: u8| char::from(byte).to_digit(16).map(|digit| digit as u8);
    let pairs = digits.as_bytes().chunks(2);
    pairs
        .map(|pair| match *pair {
            [high, low] => Some(digit(high)? << 4 | digit(low)?),
            _ => None,
        })
        .collect()
}
