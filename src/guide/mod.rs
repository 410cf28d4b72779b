//! A guide, page by page. It is text alone: no code of the crate lives here.
//!
//! | page | what it tells |
//! |---|---|
//! | [`first_triangle`] | a picture without a display, and what each piece of memory is for |
//! | [`own_display`] | a sink for your panel, by a ready one, by functions that block or by your DMA |
//! | [`own_memory`] | which memory goes where, and how much of it a scene needs |
//! | [`textures`] | a textured mesh, and the byte order of its texels |
//! | [`draw_calls`] | what else a draw call can say, lists, and what is refused |
//! | [`two_cores`] | alternate lines on two cores or threads |
//! | [`quality`] | what is paid for how exact a picture |
//! | [`figures`] | what a frame did, and what it was spared |
//! | [`scene_files`] | a scene as a file that the tool draws and shows |
//! | [`rows`] | each requirement with its code and its test |
//!
//! All examples are compiled, and those that can are run, by the tests.

#[doc = include_str!("first_triangle.md")]
pub mod first_triangle {}

#[doc = include_str!("own_display.md")]
pub mod own_display {}

#[doc = include_str!("own_memory.md")]
pub mod own_memory {}

#[doc = include_str!("textures.md")]
pub mod textures {}

#[doc = include_str!("draw_calls.md")]
pub mod draw_calls {}

#[doc = include_str!("two_cores.md")]
pub mod two_cores {}

#[doc = include_str!("quality.md")]
pub mod quality {}

#[doc = include_str!("figures.md")]
pub mod figures {}

#[doc = include_str!("scene_files.md")]
pub mod scene_files {}

#[doc = include_str!("rows.md")]
pub mod rows {}
