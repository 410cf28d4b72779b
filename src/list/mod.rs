//! Deferred instruction lists: a binary form of scenes that lies in flash, comes through a ring,
//! or is appended to while it is drawn (H11-H14, K15, X7).
//!
//! A list is a run of blocks in 32-bit words, little-endian, read where it lies. A block is a
//! header and the words that it asks for. Nothing is trusted: a block is checked whole before any
//! of it is done, a jump leads within the list, and a [`Budget`] bounds the work, so that a
//! hostile list can waste what it was given and draw rubbish, and nothing else.
//!
//! # The header
//!
//! | bits | field | |
//! |---|---|---|
//! | 31..28 | ID | the kind of block, below |
//! | 27..24 | VER | 1 |
//! | 23..8 | CNT | elements that follow; of FLOW and STATE bits 23..16 the kind, 15..8 an argument |
//! | 7 | SHADE | vertices carry colours and normal |
//! | 6 | PRSP | vertices carry depth; textures are perspective-correct |
//! | 5 | TEXT | vertices carry a texture place |
//! | 4 | NEW | a strip or fan begins; 0: the one of the block before goes on |
//! | 3 | RM | each vertex replaces the middle of the last three (fan); 0: the oldest (strip) |
//! | 2..0 | | 0, but for the flags of QUADS and INDEXED |
//!
//! A bit that a kind of block does not have must be 0.
//!
//! # The blocks
//!
//! | ID | block | bits | what follows |
//! |---|---|---|---|
//! | 0 | FLOW | | [`Flow`] |
//! | 1 | SHORT | SHADE PRSP TEXT NEW RM | CNT vertices: a strip or fan |
//! | 2 | LONG | SHADE PRSP TEXT NEW RM | CNT vertices set up beforehand: a strip or fan on the screen |
//! | 3 | POINTS | SHADE PRSP TEXT | CNT vertices, each a point |
//! | 4 | QUADS | SHADE PRSP TEXT NEW RM | CNT vertices: with RM a quad strip, two for each quad and two to begin with; else four a quad. Bit 0: split from the second corner to the fourth (K2) |
//! | 5 | TABLE | SHADE PRSP TEXT | CNT vertices in columns, for INDEXED |
//! | 6 | INDEXED | NEW RM | CNT indices into the last TABLE. Bit 0: of 16 bits, else 8; bit 1: three a triangle, else strips or fans as RM says |
//! | 7 | STATE | | [`State`] |
//! | 8..14 | | | CNT words of a later version, passed over with an event |
//! | 15 | MASTER | | CNT words: a try to reach the master state, passed over with an event |
//!
//! **Vertices** are as the vertex format in force describes them ([`VertexFormat`]): each field a
//! whole number of words, only those that the header's bits bring in, in the order of the format.
//! In a TABLE each field is a column instead, without gaps, padded to a word at its end.
//!
//! **Long vertices** are a word of x and y each, signed 13.3 from the picture's left top corner, x
//! lower; with PRSP a word of depth (1/w, the near plane at 2^31; without it the near plane);
//! with SHADE a word of colour (4x8U), else the material's; with TEXT a word of u and v (2x16U).
//! They are not lit, moved or clipped; what lies farther out than 2,047 pixels from the picture's middle is moved to there.
//!
//! **Points** are squares of as many pixels each way as POINT SIZE says, of one at first, around
//! their vertices, with their depths. They are lit by their own normals.
//!
//! **Textures** are drawn with where the header has TEXT and the material names one. Sides are 1.0
//! of a texture place. Without PRSP places may be half a texel off, so that fewer divisions are needed.
//! A texture is found by its number when the next block draws, and its palette too.
//!
//! **Strips** are mended so that all triangles show the side that the first one shows. One that
//! goes on (NEW 0) must have the same ID, SHADE, PRSP and TEXT, and no FORMAT, TABLE or other vertices between, points
//! among them; its kept vertices are taken in the state that is in force then. In INDEXED an index of all ones
//! ends a strip and begins another. Indices lie lowest bits first; what is left over in the last
//! word is passed over.
//!
//! # Where things are
//!
//! | file | there |
//! |---|---|
//! | `header.rs` | the header |
//! | `format.rs` | the table that describes a vertex |
//! | `block.rs` | blocks as values, each payload to the bit |
//! | `words.rs` | slices and rings of words |
//! | `reader.rs` | words into blocks |
//! | `vertex.rs` | parameters out of vertices and columns |
//! | `strip.rs` | vertices into triangles |
//! | `texels.rs` | texels where they lie, and which texture is which |
//! | `overlays.rs` | pixels over the picture |
//! | `flow.rs` | which block comes next: jumps, commands, budget |
//!
//! Lists are written on the host: `scanbeam bake` makes them of models.
//! A list is drawn by a [`Player`](crate::input::Player) into a [`Scene`](crate::scene::Scene); this room knows neither.

mod block;
mod error;
mod flow;
mod format;
mod header;
mod overlays;
mod reader;
mod strip;
mod texels;
mod vertex;
mod words;

pub use block::{
    Bounds, CameraWords, Cone, Flow, Head, Instruction, LightWords, Material, Matrix, Overlay,
    Palette, Run, State, TexelForm, Texture, Window,
};
pub use error::{Lent, ListError, Missing, Reason};
pub use flow::{Budget, Halt, ListCommand, ListControl, Step, Walker};
pub use format::{Field, FieldForm, VertexFormat};
pub use header::{Header, Id};
pub use overlays::OverlaySlot;
pub(crate) use overlays::OverlaySlots;
pub use reader::{Parsed, read_block};
pub use strip::Strip;
pub(crate) use texels::Pair;
pub use texels::{Texels, TextureSlot, TextureSlots};
pub(crate) use vertex::colour;
pub use vertex::{Layout, Place, Slot};
pub use words::{ListRing, RingFull, RingReader, RingWords, RingWriter, Words, words_of};
