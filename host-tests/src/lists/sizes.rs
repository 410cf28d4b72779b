//! What of a list takes how many bytes, and the report of a baked one.

use super::bake::Baked;
use scanbeam::list::{Instruction, ListError, State, VertexFormat, read_block};
use serde::Serialize;
use serde_json::json;
use std::error::Error;

/// Bytes by what they say, headers included; together they are the whole list.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Sizes {
    /// Vertices, in tables or one after the other.
    pub vertices: usize,
    /// Indices.
    pub indices: usize,
    /// Texels.
    pub texels: usize,
    /// Palettes.
    pub palettes: usize,
    /// Overlays.
    pub overlays: usize,
    /// All else: matrices, materials, formats, flow.
    pub state: usize,
}

impl Sizes {
    /// Of a list, block by block as they lie.
    ///
    /// # Errors
    /// When it is malformed.
    pub fn of(list: &[u32]) -> Result<Self, ListError> {
        let mut sizes = Self::default();
        let mut format = VertexFormat::default();
        let mut at = 0;
        while (at as usize) < list.len() {
            let parsed = read_block(list, at, &format)?;
            let sum = match parsed.instruction {
                Instruction::Short(_)
                | Instruction::Long(_)
                | Instruction::Points(_)
                | Instruction::Quads(_)
                | Instruction::Table(_) => &mut sizes.vertices,
                Instruction::Indexed(_) => &mut sizes.indices,
                Instruction::State(State::Texture(_)) => &mut sizes.texels,
                Instruction::State(State::Palette(_)) => &mut sizes.palettes,
                Instruction::State(State::Overlay(_)) => &mut sizes.overlays,
                _ => &mut sizes.state,
            };
            *sum += 4 * parsed.words as usize;
            if let Instruction::State(State::Format(new)) = parsed.instruction {
                format = new;
            }
            at += parsed.words;
        }
        Ok(sizes)
    }

    /// The parts that are there, by name.
    pub fn parts(&self) -> impl Iterator<Item = (&'static str, usize)> {
        let all = [
            ("vertices", self.vertices),
            ("indices", self.indices),
            ("texels", self.texels),
            ("palettes", self.palettes),
            ("overlays", self.overlays),
            ("state", self.state),
        ];
        all.into_iter().filter(|(_, bytes)| *bytes > 0)
    }
}

/// Prints what was baked.
pub(super) fn report(b: &Baked, json: bool) -> Result<(), Box<dyn Error>> {
    let [strips, fans, separate] = b.runs;
    let bytes = 4 * b.words.len();
    let sizes = Sizes::of(&b.words)?;
    if json {
        let textures: Vec<_> = b
            .textures
            .iter()
            .map(|t| {
                let [width, height] = t.log_sides.map(|log| 1 << log);
                json!({
                    "width": width,
                    "height": height,
                    "form": format!("{:?}", t.form),
                    "colours": t.palette.len(),
                    "bytes": t.bytes(),
                    "error": t.error,
                })
            })
            .collect();
        let report = json!({
            "bytes": bytes,
            "triangles": b.triangles,
            "triangles_dropped": b.dropped,
            "bytes_per_triangle": b.bytes_per_triangle(),
            "vertices": b.vertices,
            "strips": strips,
            "fans": fans,
            "separate": separate,
            "parts": b.parts,
            "place": format!("{:?}", b.place),
            "normal": b.normal.map(|n| format!("{n:?}")),
            "error": b.error,
            "normal_error_degrees": b.normal_error,
            "largest_table": b.table,
            "sizes": sizes,
            "textures": textures,
        });
        say!("{}", serde_json::to_string_pretty(&report)?);
        return Ok(());
    }
    say!(
        "{bytes} bytes, {} triangles: {:.2} bytes a triangle but for texels",
        b.triangles,
        b.bytes_per_triangle()
    );
    let parts: Vec<String> = sizes
        .parts()
        .map(|(name, bytes)| format!("{name} {bytes}"))
        .collect();
    say!("bytes: {}", parts.join(", "));
    say!(
        "{} vertices in tables of at most {}; {strips} strips, {fans} fans, {separate} triangles alone",
        b.vertices,
        b.table
    );
    if b.parts > 0 {
        say!(
            "{} parts that are passed over where they are turned away",
            b.parts
        );
    }
    say!("places {:?}, moved by {:.3e} at most", b.place, b.error);
    if let Some(normal) = b.normal {
        say!(
            "normals {normal:?}, turned by {:.3} degrees at most",
            b.normal_error
        );
    }
    for (number, t) in b.textures.iter().enumerate() {
        let [width, height] = t.log_sides.map(|log| 1 << log);
        say!(
            "texture {number}: {width} x {height} {:?}, {} colours, {} bytes, off by {:.2} levels",
            t.form,
            t.palette.len(),
            t.bytes(),
            t.error
        );
    }
    if b.places_cut > 0 {
        tell!(
            "warning: {} texture places are more than 16 sides from their neighbours, and cut off there",
            b.places_cut
        );
    }
    if b.dropped > 0 {
        say!("{} triangles fell together and are left out", b.dropped);
    }
    Ok(())
}
