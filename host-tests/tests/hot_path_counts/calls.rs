//! Draw calls of one triangle each, with values at random.

use crate::common::Rng;
use crate::hot::Corner;
use crate::hot::values::{
    Cut, FUNCTIONS, Function, HOLED, NEARER_OR_EQUAL, PLACES, WHITE, depth_test, some_corners,
    some_mode,
};
use crate::hot_path_depth::{bound, exact};
use scanbeam::scene::{Blend, BlendMode, Budget, DepthFunction, Draw, Shadow, Skin};
use scanbeam::{Cull, Screen};
use std::cmp::Ordering;

/// What a draw call has for a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Skinned {
    Bare,
    Whole,
    Holed,
}

/// A draw call of one triangle, and its values.
#[derive(Clone, Debug)]
pub(super) struct Call {
    pub(super) corners: [Corner; 3],
    pub(super) cut: Option<Cut>,
    pub(super) test: [Function; 2],
    pub(super) blend: Option<BlendMode>,
    pub(super) priority: u8,
    pub(super) skin: Skinned,
    pub(super) dither: bool,
    pub(super) shadow: Option<Shadow>,
}

/// What scenes have besides triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Bare,
    Ranked,
    Valued,
    ValuedAndRanked,
    Shadowed,
}

pub(super) const KINDS: [Kind; 5] = [
    Kind::Bare,
    Kind::Ranked,
    Kind::Valued,
    Kind::ValuedAndRanked,
    Kind::Shadowed,
];

impl Call {
    pub(super) fn new(rng: &mut Rng, screen: Screen, kind: Kind) -> Self {
        let mut call = Self {
            corners: some_corners(rng, screen),
            cut: None,
            test: [NEARER_OR_EQUAL; 2],
            blend: None,
            priority: 0,
            skin: rng.pick(&[Skinned::Bare, Skinned::Whole]),
            dither: false,
            shadow: None,
        };
        for corner in &mut call.corners {
            corner.colour = [255; 3];
        }
        if matches!(kind, Kind::Ranked | Kind::ValuedAndRanked) {
            call.priority = 1 + rng.below(4) as u8;
        }
        if matches!(kind, Kind::Valued | Kind::ValuedAndRanked) {
            call.cut = (rng.below(4) == 0).then(|| Cut::new(rng, screen));
            call.blend = (rng.below(4) == 0).then(|| some_mode(rng));
            call.dither = rng.below(8) == 0;
            if rng.below(4) == 0 {
                call.test = [(); 2].map(|()| rng.pick(&FUNCTIONS));
            }
            if rng.below(4) == 0 {
                call.skin = Skinned::Holed;
            }
        }
        call
    }

    /// Triangles of a kind; some are there twice, so that depths are equal.
    pub(super) fn some(rng: &mut Rng, screen: Screen, kind: Kind) -> Vec<Self> {
        let many = rng.pick(&[3, 8, 8, 20]);
        let mut calls: Vec<Self> = Vec::new();
        for _ in 0..1 + rng.below(many) {
            let mut call = Self::new(rng, screen, kind);
            if let (0, Some(last)) = (rng.below(5), calls.last()) {
                call.corners = last.corners;
            }
            calls.push(call);
        }
        if kind != Kind::Shadowed {
            return calls;
        }
        let mut more = Vec::new();
        for call in &calls {
            for _ in 0..rng.below(3) {
                let light = rng.pick(&[0, 5]);
                let mut call = call.clone();
                call.shadow = Some(rng.pick(&[Shadow::Lit(light), Shadow::Shadowed(light)]));
                call.blend = rng.pick(&[None, Some(BlendMode::Add(200))]);
                call.skin = rng.pick(&[Skinned::Bare, Skinned::Whole, Skinned::Holed]);
                call.cut = (rng.below(5) == 0).then(|| Cut::new(rng, screen));
                more.push(call);
            }
        }
        for _ in 0..rng.below(many) {
            let mut call = Self::new(rng, screen, kind);
            call.shadow = Some(Shadow::Volume(rng.pick(&[0, 5, 6])));
            call.cut = (rng.below(5) == 0).then(|| Cut::new(rng, screen));
            more.push(call);
        }
        calls.append(&mut more);
        rng.shuffle(&mut calls);
        calls
    }

    pub(super) fn dress(&self, call: &mut Draw<'_, '_, i32>, is_textured: bool) {
        let texture = match self.skin {
            Skinned::Bare => None,
            Skinned::Whole => Some(&WHITE),
            Skinned::Holed => Some(&HOLED),
        };
        call.texture = texture.filter(|_| is_textured).map(|texture| Skin {
            texture,
            places: &PLACES,
            budget: Budget::BALANCED,
        });
        call.cull = Cull::None;
        call.scissor = self.cut.as_ref().map(Cut::scissor);
        call.depth = depth_test(self.test);
        call.priority = self.priority;
        call.blend = self.blend.map(Blend::new);
        call.dither = self.dither;
        call.shadow = self.shadow;
    }

    pub(super) fn is_translucent(&self) -> bool {
        self.blend.is_some_and(|mode| mode != BlendMode::Replace)
    }

    /// Whether its depth is compared wherever it is.
    pub(super) fn compares(&self) -> bool {
        let differs = |f: Function| f.0 != DepthFunction::NEARER_OR_EQUAL;
        self.blend.is_some() || self.shadow.is_some() || self.test.into_iter().any(differs)
    }

    pub(super) fn has_values(&self, is_textured: bool) -> bool {
        let has_holes = is_textured && self.skin == Skinned::Holed;
        self.cut.is_some() || has_holes || self.compares()
    }

    /// How it compares with another at a pixel; `None` where that hangs on what depth may err.
    pub(super) fn compare(&self, other: Option<&Self>, [x, y]: [u16; 2]) -> Option<Ordering> {
        let Some(other) = other else {
            // Nothing is as far as what nobody has drawn.
            return Some(Ordering::Greater);
        };
        let same = |(a, b): (&Corner, &Corner)| a.at == b.at && a.w == b.w;
        if self.corners.iter().zip(&other.corners).all(same) {
            return Some(Ordering::Equal);
        }
        let depth = |call: &Self| exact(&call.corners, x.into(), y);
        let apart = depth(self) - depth(other);
        let off = bound(&self.corners) + bound(&other.corners);
        (apart.abs() > off).then(|| apart.total_cmp(&0.0))
    }
}
