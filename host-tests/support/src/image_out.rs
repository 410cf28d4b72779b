//! Pictures to files: PNG, PPM, strips, animated PNG; and a reader of the same for tests and textures.
//!
//! A picture is encoded whole, written to a temporary file in the same folder and renamed, so that an error leaves
//! what was there before, and never half a file. Pipes and devices such as `/dev/stdout` are written as they are. The
//! animated picture is an APNG: true colour, and viewers that know
//! only PNG show its first frame.

pub use crate::staged::{Staged, write_atomically};

use crate::stdio;
use std::fmt;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// Longest side of a picture that is read or written, in pixels, inclusive.
pub const MAX_SIDE: u32 = 1 << 16;
/// Most pixels of a picture that is read or written, inclusive.
pub const MAX_PIXELS: u64 = 1 << 28;

/// A picture of 8 bits per channel, rows from the top, no padding.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frame {
    width: u32,
    height: u32,
    rgb: Vec<u8>,
}

impl Frame {
    /// Takes `width * height * 3` bytes: red, green, blue, row by row from the top. `None` when the count differs, a
    /// side is zero or more than [`MAX_SIDE`], or there are more than [`MAX_PIXELS`] pixels.
    #[must_use]
    pub fn new(width: u32, height: u32, rgb: Vec<u8>) -> Option<Self> {
        let pixels = pixel_count(width, height)?;
        (rgb.len() == pixels * 3).then_some(Self { width, height, rgb })
    }

    /// Pixels per row, at least 1.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows, at least 1.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All channels, row by row from the top.
    #[must_use]
    pub fn rgb(&self) -> &[u8] {
        &self.rgb
    }

    /// Red, green, blue at a place; `None` outside.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        if x >= self.width {
            return None;
        }
        let at = (y as usize * self.width as usize + x as usize) * 3;
        self.rgb.get(at..at + 3)?.try_into().ok()
    }

    fn rows(&self) -> impl Iterator<Item = &[u8]> {
        self.rgb.chunks_exact(self.width as usize * 3)
    }
}

/// Pixels of a picture with allowed sides.
fn pixel_count(width: u32, height: u32) -> Option<usize> {
    let sides = 1..=MAX_SIDE;
    let pixels = u64::from(width) * u64::from(height);
    (sides.contains(&width) && sides.contains(&height) && pixels <= MAX_PIXELS)
        .then(|| usize::try_from(pixels).ok())?
}

/// How a picture is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImageFormat {
    /// `.png`
    Png,
    /// `.ppm`, the binary kind (P6)
    Ppm,
}

impl ImageFormat {
    /// By the extension, in either case.
    ///
    /// # Errors
    /// Any other extension, or none.
    pub fn from_path(path: &Path) -> Result<Self, ImageError> {
        let extension = path.extension().map(|text| text.to_ascii_lowercase());
        match extension.as_ref().and_then(|text| text.to_str()) {
            Some("png") => Ok(Self::Png),
            Some("ppm") => Ok(Self::Ppm),
            _ => Err(ImageError::new(
                path,
                "unknown picture extension, .png or .ppm is needed",
            )),
        }
    }
}

/// Why a picture could not be written or read: one line, `FILE: reason`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ImageError {
    /// The file that was to be written or read.
    pub file: PathBuf,
    /// What went wrong, without the file's name.
    pub reason: String,
}

impl ImageError {
    pub(crate) fn new(file: &Path, reason: impl fmt::Display) -> Self {
        Self {
            file: file.to_path_buf(),
            reason: reason.to_string(),
        }
    }
}

impl fmt::Display for ImageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = format!("{}: {}", self.file.display(), self.reason);
        // Names come from outside: a control character must not break the one line into two.
        let text: String = text
            .chars()
            .map(|c| if c.is_control() { '?' } else { c })
            .collect();
        f.write_str(&text)
    }
}

impl std::error::Error for ImageError {}

/// Makes a folder, and those above it, where they are missing.
///
/// # Errors
/// Anything that the file system refuses.
pub fn make_folder(folder: &Path) -> Result<(), ImageError> {
    std::fs::create_dir_all(folder).map_err(|error| {
        ImageError::new(
            folder,
            format_args!("cannot be made: {}", stdio::reason(&error)),
        )
    })
}

/// What could not be done, and why.
pub(crate) fn cannot(what: &str, error: &std::io::Error) -> String {
    format!("cannot be {what}: {}", stdio::reason(error))
}

/// Writes one picture as PNG or PPM, by the extension.
///
/// # Errors
/// Unknown extension, or a file that cannot be written.
pub fn write_image(path: &Path, frame: &Frame) -> Result<(), ImageError> {
    write_atomically(path, &encode_image(path, frame)?)
}

/// The bytes that [`write_image`] writes.
///
/// # Errors
/// Unknown extension.
pub fn encode_image(path: &Path, frame: &Frame) -> Result<Vec<u8>, ImageError> {
    match ImageFormat::from_path(path)? {
        ImageFormat::Png => {
            encode_png(std::slice::from_ref(frame), 0).map_err(|error| ImageError::new(path, error))
        }
        ImageFormat::Ppm => Ok(encode_ppm(frame)),
    }
}

/// Writes frames side by side, the first at the left, as one picture.
///
/// # Errors
/// No frames, frames of different heights, a strip of too many pixels, and as [`write_image`].
pub fn write_strip(path: &Path, frames: &[Frame]) -> Result<(), ImageError> {
    let strip = strip(frames).ok_or_else(|| {
        ImageError::new(path, "frames of one height, and not too many, are needed")
    })?;
    write_image(path, &strip)
}

fn strip(frames: &[Frame]) -> Option<Frame> {
    let height = frames.first()?.height;
    let width = frames
        .iter()
        .try_fold(0_u32, |width, frame| width.checked_add(frame.width))?;
    pixel_count(width, height)?;
    let mut rows = vec![Vec::with_capacity(width as usize * 3); height as usize];
    for frame in frames {
        if frame.height != height {
            return None;
        }
        for (row, part) in rows.iter_mut().zip(frame.rows()) {
            row.extend_from_slice(part);
        }
    }
    Frame::new(width, height, rows.concat())
}

/// Writes an animated PNG that repeats for ever, `frame_ms` milliseconds a frame.
///
/// # Errors
/// No frames, frames of different sizes, an extension that is not `.png`, or a file that cannot be written.
pub fn write_animation(path: &Path, frames: &[Frame], frame_ms: u16) -> Result<(), ImageError> {
    if ImageFormat::from_path(path)? != ImageFormat::Png {
        return Err(ImageError::new(path, "an animated picture needs .png"));
    }
    let bytes = encode_png(frames, frame_ms).map_err(|error| ImageError::new(path, error))?;
    write_atomically(path, &bytes)
}

/// One frame as a plain PNG, several as an animated one.
fn encode_png(frames: &[Frame], frame_ms: u16) -> Result<Vec<u8>, String> {
    let first = frames.first().ok_or("no frames")?;
    if frames
        .iter()
        .any(|f| (f.width, f.height) != (first.width, first.height))
    {
        return Err("frames differ in size".into());
    }
    let encode = || -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, first.width, first.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        if frames.len() > 1 {
            encoder.set_animated(frames.len() as u32, 0)?;
            encoder.set_frame_delay(frame_ms, 1000)?;
        }
        let mut writer = encoder.write_header()?;
        for frame in frames {
            writer.write_image_data(&frame.rgb)?;
        }
        writer.finish()?;
        Ok(bytes)
    };
    encode().map_err(|error| format!("cannot be encoded: {error}"))
}

fn encode_ppm(frame: &Frame) -> Vec<u8> {
    let mut bytes = format!("P6\n{} {}\n255\n", frame.width, frame.height).into_bytes();
    bytes.extend_from_slice(&frame.rgb);
    bytes
}

/// A picture with what it says of its transparency.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cutout {
    /// Its colours.
    pub frame: Frame,
    /// The alpha of each pixel, 255 for opaque; `None` where all are.
    pub alpha: Option<Vec<u8>>,
}

impl From<Frame> for Cutout {
    fn from(frame: Frame) -> Self {
        Self { frame, alpha: None }
    }
}

/// Reads a PNG (any colour type; transparency is dropped; of an animation the first frame), a JPEG, or a binary PPM of
/// 8 bits, by the extension.
///
/// # Errors
/// Unknown extension, missing file, malformed or oversized picture.
pub fn read_image(path: &Path) -> Result<Frame, ImageError> {
    Ok(read_cutout(path)?.frame)
}

/// The same, with the transparency of a PNG.
///
/// # Errors
/// As [`read_image`].
pub fn read_cutout(path: &Path) -> Result<Cutout, ImageError> {
    let extension = path.extension().map(|text| text.to_ascii_lowercase());
    let jpeg = extension.is_some_and(|text| text == "jpg" || text == "jpeg");
    let format = match jpeg {
        true => None,
        false => Some(ImageFormat::from_path(path).map_err(|_| {
            let reason = "unknown picture extension, .png, .jpg or .ppm is needed";
            ImageError::new(path, reason)
        })?),
    };
    let bytes =
        std::fs::read(path).map_err(|error| ImageError::new(path, cannot("read", &error)))?;
    match format {
        Some(ImageFormat::Png) => decode_png(&bytes),
        Some(ImageFormat::Ppm) => decode_ppm(&bytes).map(Cutout::from),
        None => decode_jpeg(&bytes).map(Cutout::from),
    }
    .map_err(|reason| ImageError::new(path, reason))
}

/// Reads a PNG or a JPEG, whichever it is.
///
/// # Errors
/// When it is neither, or malformed.
pub fn decode_image(bytes: &[u8]) -> Result<Frame, String> {
    Ok(decode_cutout(bytes)?.frame)
}

/// The same, with the transparency of a PNG.
///
/// # Errors
/// As [`decode_image`].
pub fn decode_cutout(bytes: &[u8]) -> Result<Cutout, String> {
    match bytes {
        [0xFF, 0xD8, ..] => decode_jpeg(bytes).map(Cutout::from),
        _ => decode_png(bytes),
    }
}

/// Whether a JPEG goes on to its end marker: the decoder makes up what is missing.
fn has_jpeg_end(bytes: &[u8]) -> bool {
    // In pixels 0xFF is followed by 0, and restarts have no length.
    let is_marker = |two: &[u8]| two[0] == 0xFF && !matches!(two[1], 0 | 1 | 0xD0..=0xD7 | 0xFF);
    let mut rest = bytes.get(2..).unwrap_or_default();
    while let Some(at) = rest.windows(2).position(is_marker) {
        rest = &rest[at + 1..];
        match *rest {
            [0xD9, ..] => return true,
            [_, high, low, ..] => {
                let segment = 1 + usize::from(u16::from_be_bytes([high, low]));
                rest = rest.get(segment..).unwrap_or_default();
            }
            _ => return false,
        }
    }
    false
}

fn decode_jpeg(bytes: &[u8]) -> Result<Frame, String> {
    if !has_jpeg_end(bytes) {
        return Err("is not a good JPEG: it has no end".into());
    }
    let malformed = |error: DecodeErrors| format!("is not a good JPEG: {error}");
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(ColorSpace::RGB)
        .set_strict_mode(true)
        .set_max_width(MAX_SIDE as usize)
        .set_max_height(MAX_SIDE as usize);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    let rgb = decoder.decode().map_err(malformed)?;
    let info = decoder.info().ok_or("is not a good JPEG")?;
    Frame::new(info.width.into(), info.height.into(), rgb)
        .ok_or_else(|| "is not a good JPEG: wrong length".into())
}

fn decode_png(bytes: &[u8]) -> Result<Cutout, String> {
    let malformed = |error: png::DecodingError| format!("is not a good PNG: {error}");
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(malformed)?;
    let (width, height) = (reader.info().width, reader.info().height);
    pixel_count(width, height).ok_or("is too large")?;
    let mut data = vec![0; reader.output_buffer_size().ok_or("is too large")?];
    let info = reader.next_frame(&mut data).map_err(malformed)?;
    data.truncate(info.buffer_size());
    let last = |channels| data.iter().skip(channels - 1).step_by(channels).copied();
    let alpha: Option<Vec<u8>> = match info.color_type {
        png::ColorType::Rgba => Some(last(4).collect()),
        png::ColorType::GrayscaleAlpha => Some(last(2).collect()),
        _ => None,
    };
    let rgb = match info.color_type {
        png::ColorType::Rgb => data,
        png::ColorType::Rgba => data
            .chunks_exact(4)
            .flat_map(|p| [p[0], p[1], p[2]])
            .collect(),
        png::ColorType::Grayscale => data.iter().flat_map(|&grey| [grey; 3]).collect(),
        png::ColorType::GrayscaleAlpha => data.chunks_exact(2).flat_map(|p| [p[0]; 3]).collect(),
        png::ColorType::Indexed => return Err("is not a good PNG: no palette".into()),
    };
    let frame = Frame::new(width, height, rgb);
    Ok(Cutout {
        frame: frame.ok_or("is not a good PNG: wrong length")?,
        alpha: alpha.filter(|alpha| alpha.iter().any(|alpha| *alpha < 255)),
    })
}

fn decode_ppm(bytes: &[u8]) -> Result<Frame, String> {
    let malformed = || "is not a good binary PPM of 8 bits".to_owned();
    let mut rest = bytes.strip_prefix(b"P6").ok_or_else(malformed)?;
    let mut header = [0_u32; 3];
    for number in &mut header {
        // White space and comments, then digits.
        loop {
            match rest.first() {
                Some(b'#') => {
                    let end = rest.iter().position(|&byte| byte == b'\n');
                    rest = &rest[end.ok_or_else(malformed)?..];
                }
                Some(byte) if byte.is_ascii_whitespace() => rest = &rest[1..],
                _ => break,
            }
        }
        let digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
        let text = std::str::from_utf8(&rest[..digits]).map_err(|_| malformed())?;
        *number = text.parse().map_err(|_| malformed())?;
        rest = &rest[digits..];
    }
    let [width, height, 255] = header else {
        return Err(malformed());
    };
    let pixels = pixel_count(width, height).ok_or("is too large, or empty")?;
    // One white space ends the header; bytes after the picture are allowed.
    let data = rest.get(1..1 + pixels * 3).ok_or_else(malformed)?;
    Frame::new(width, height, data.to_vec()).ok_or_else(malformed)
}
