//! The frames that are drawn on the host and on every target, by name.

use crate::{
    IN_FORMATS, IN_PARTS, InFormat, PACED, PLAYED, Paced, Played, SCENES_B, SHOTS, STRESS, SUITE,
    SceneB, Shot, Suite, VALUES, VARIANTS, Values, Variant,
};

/// What a frame is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// A scene of the suite, with 64 slots and one line a transfer, as it is measured.
    Suite(Suite),
    /// A scene of the suite whose mesh is drawn in parts.
    InParts(Suite),
    /// A scene in other pixels than an SPI panel's.
    Format(InFormat),
    /// A scene of the suite whose lines cost no more than they may.
    Paced(Paced),
    /// A small frame of what few draw calls have.
    Values(Values),
    /// A list that is played.
    Played(Played),
    /// A shot, in one of the ways that must not change it.
    Shot(Variant),
    /// Scene B on the upright sphere.
    B(SceneB),
    /// A shot by the hardware model.
    Model(Shot),
}

impl Frame {
    /// Whether a frame of [`unhurried`] has textures.
    #[must_use]
    pub fn is_textured(&self) -> bool {
        match self {
            Self::Suite(suite) | Self::Paced(Paced { suite, .. }) => suite.texture().is_some(),
            Self::B(_) => true,
            _ => false,
        }
    }
}

/// The frames that may be paced, by their renderers and sizes, each once.
pub fn unhurried() -> impl Iterator<Item = (&'static str, Frame)> {
    frames().filter(|(_, frame)| match frame {
        Frame::Suite(_) | Frame::B(_) => true,
        // Those with the costs of M0+ code are the same scenes.
        Frame::Paced(paced) => !paced.is_in_m0_code(),
        Frame::Shot(how) => *how == Variant::of(how.shot),
        _ => false,
    })
}

/// Every frame, in the order in which they are drawn: the suite, and of it what is drawn in parts and what is paced, what few draw calls have, lists, all other shots,
/// those of stress too, then what the cache and its renderers must not change, and faces of one colour, scene B, other
/// pixels, and one by the hardware model.
pub fn frames() -> impl Iterator<Item = (&'static str, Frame)> {
    let suite = SUITE.map(|suite| (suite.name(), Frame::Suite(suite)));
    let parts = IN_PARTS.map(|(name, suite)| (name, Frame::InParts(suite)));
    let paced = PACED.map(|paced| (paced.name, Frame::Paced(paced)));
    let values = VALUES.map(|(name, values)| (name, Frame::Values(values)));
    let played = PLAYED.map(|(name, played)| (name, Frame::Played(played)));
    let measured = |shot: &Shot| SUITE.iter().any(|suite| suite.name() == shot.name());
    let shots = SHOTS.into_iter().filter(move |shot| !measured(shot));
    let shots = shots.chain(STRESS).map(Variant::of).chain(VARIANTS);
    suite
        .into_iter()
        .chain(parts)
        .chain(paced)
        .chain(values)
        .chain(played)
        .chain(shots.map(|how| (how.name, Frame::Shot(how))))
        .chain(SCENES_B.map(|scene| (scene.name, Frame::B(scene))))
        .chain(IN_FORMATS.map(|(name, scene)| (name, Frame::Format(scene))))
        .chain([("teapot_model", Frame::Model(Shot::Teapot))])
}
