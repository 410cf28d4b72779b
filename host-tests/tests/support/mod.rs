//! What the tool and the proofs stand on, each by itself; here for the reason that `tool` has.

mod image_out;
mod model;
mod reference;
mod stdio;
mod texture_file;
