//! Bytes that a scene is lent. All records but those with pointers are as large on the boards as here.

use scanbeam::Link;
use scanbeam::frame::FastMemory;
use scanbeam::input::{LightRoom, TextureRoom};
use scanbeam::list::TextureSlot;
use scanbeam::look::Look;
use scanbeam::scene::{CacheWord, DrawState, Object, ShadowEdge, Texture, TexturePlace, Vertex};
use scene_flash::{CACHED, Counts, Head, Kind, ListRoom};

/// Bytes of the state of a draw call here: it has pointers.
pub const DRAW_BYTES: usize = size_of::<DrawState<'_>>();
/// Bytes that a triangle takes which throws a shadow, while its volume is made.
pub const VOLUME_BYTES: usize =
    3 * size_of::<ShadowEdge>() + 6 * size_of::<[i32; 3]>() + 6 * size_of::<[u16; 3]>();

/// What a scene of the head's room is lent in slow memory, and its renderer, where the state of a draw call has so many
/// bytes.
#[must_use]
pub fn slow_bytes(head: &Head, draw_bytes: usize) -> usize {
    let place = if head.kind.is_textured() {
        size_of::<TexturePlace>()
    } else {
        0
    };
    let room = [head.room.vertices, head.room.objects, head.room.draws].map(|n| n as usize);
    room[0] * (size_of::<Vertex>() + place)
        + room[1] * (size_of::<Object>() + size_of::<Link>())
        + room[2] * draw_bytes
        + usize::from(head.size[1]) * size_of::<u16>()
}

/// What a player is lent, as large as it is here: some of it has pointers.
#[must_use]
pub fn list_bytes(room: &ListRoom) -> usize {
    let of = |count: u32, bytes: usize| (count as usize).saturating_mul(bytes);
    let texture = size_of::<Texture<'_>>();
    [
        of(
            room.table,
            2 * size_of::<[i16; 3]>() + 4 + size_of::<[i32; 2]>(),
        ),
        of(room.indices, 2),
        of(room.names, size_of::<TextureSlot>()),
        of(room.textures, size_of::<TextureRoom<'_>>()),
        of(room.texels, 2),
        of(room.levels, texture),
        size_of::<LightRoom>(),
    ]
    .into_iter()
    .fold(0, usize::saturating_add)
}

/// What is lent beside the object cache in fast memory: the depth of a line; of draw calls also caches of texels and
/// counts of shadows, and indices of a line or two lines that are doubled.
#[must_use]
pub fn fast_bytes(head: &Head, counts: Option<&Counts>) -> usize {
    let width = usize::from(head.size[0]);
    let lines = |yes: bool, bytes: usize| if yes { width * bytes } else { 0 };
    let (caches, volumes) = counts.map_or((0, 0), |counts| {
        (counts.textures.caches as usize, counts.volumes)
    });
    width * size_of::<u32>()
        + lines(head.doubled, 2 * size_of::<u16>())
        + lines(head.kind == Kind::Indexed, size_of::<u8>())
        + lines(volumes > 0, size_of::<u8>())
        + CACHED * caches * size_of::<CacheWord>()
}

/// Bytes of an object cache of so many slots, rounded up to whole words of 32, with what it keeps beside them.
#[must_use]
pub fn cache_bytes<L: Look>(slots: u16) -> usize {
    const ONE: usize = 32;
    let (one, two) = (size_of::<FastMemory<L, 1>>(), size_of::<FastMemory<L, 2>>());
    // It has as much more for each word of slots as the second has more than the first.
    let words = usize::from(slots).div_ceil(ONE).max(1);
    one + (words - 1) * (two - one)
}

/// Bytes of two buffers of a line that is sent.
#[must_use]
pub fn line_bytes(head: &Head) -> usize {
    2 * size_of::<u16>() * usize::from(head.sent()[0])
}
