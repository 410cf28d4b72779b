//! Draw calls that are not drawn among what is opaque: what is translucent, and what has to do with shadows (K9, K11).

use super::{Blend, DepthTest, Master, Shadow};
use crate::geometry::DepthFunction;

/// What triangles of a draw call have to do with shadows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Role {
    /// Nothing.
    #[default]
    None,
    /// Faces of a volume that are seen from outside.
    Front(u8),
    /// Faces of a volume that are seen from inside.
    Back(u8),
    /// Surfaces again, where the light reaches them.
    Lit(u8),
    /// Surfaces again, in the shadow.
    Shadowed(u8),
}

impl Role {
    /// That of a call, of a volume that of the faces that are filed first.
    pub(super) fn of(shadow: Option<Shadow>, master: Master) -> Self {
        match shadow {
            Some(shadow) if master.has_depth() => match shadow {
                Shadow::Volume(light) => Self::Front(light),
                Shadow::Lit(light) => Self::Lit(light),
                Shadow::Shadowed(light) => Self::Shadowed(light),
            },
            _ => Self::None,
        }
    }

    /// How a call compares, which asks for `test`.
    pub(super) fn depth(self, test: DepthTest) -> DepthTest {
        let usual = match self {
            Self::None => return test,
            Self::Front(_) | Self::Back(_) => DepthFunction::NEARER,
            Self::Lit(_) | Self::Shadowed(_) => DepthFunction::EQUAL,
        };
        let is_usual = test == DepthTest::HIDES;
        let function = if is_usual { usual } else { test.colour_if };
        DepthTest::new(function).without_write()
    }
}

/// When a draw call is drawn, and its role, in a byte: a draw state has room for one more.
///
/// Bits 0 to 2 are the light; 3 to 5 tell roles apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Late(u8);

impl Late {
    /// Among what is opaque.
    pub(super) const NOT: Self = Self(0);

    const LIGHT: u8 = 7;
    const ROLE: u8 = 7 << 3;
    const FRONT: u8 = 1 << 3;
    const BACK: u8 = 2 << 3;
    const LIT: u8 = 3 << 3;
    const SHADOWED: u8 = 4 << 3;
    const TRANSLUCENT: u8 = 5 << 3;
    /// Later, where depth is compared.
    const COMPARED: u8 = 1 << 6;
    /// Never, where it is not.
    const UNCOMPARED: u8 = 1 << 7;

    pub(super) fn of(role: Role, blend: Option<Blend>) -> Self {
        const NEVER: u8 = Late::COMPARED | Late::UNCOMPARED;
        const { assert!(Shadow::LIGHTS - 1 == Self::LIGHT) };
        let (when, what, light) = match role {
            Role::None if blend.is_some_and(|blend| blend.is_translucent()) => {
                (Self::COMPARED, Self::TRANSLUCENT, 0)
            }
            Role::None => return Self::NOT,
            Role::Lit(light) => (Self::COMPARED, Self::LIT, light),
            // Nothing is to be seen of it where nothing is counted.
            Role::Front(light) => (NEVER, Self::FRONT, light),
            Role::Back(light) => (NEVER, Self::BACK, light),
            Role::Shadowed(light) => (NEVER, Self::SHADOWED, light),
        };
        Self(when | what | light & Self::LIGHT)
    }

    pub(super) fn role(self) -> Role {
        let light = self.0 & Self::LIGHT;
        match self.0 & Self::ROLE {
            Self::FRONT => Role::Front(light),
            Self::BACK => Role::Back(light),
            Self::LIT => Role::Lit(light),
            Self::SHADOWED => Role::Shadowed(light),
            _ => Role::None,
        }
    }

    /// The faces of a volume that are seen from inside, in place of the others.
    pub(super) fn turned(self) -> Self {
        match self.role() {
            Role::Front(_) => Self(self.0 ^ Self::FRONT ^ Self::BACK),
            _ => self,
        }
    }

    #[inline(always)]
    pub(super) fn is_translucent(self) -> bool {
        self.0 & Self::ROLE == Self::TRANSLUCENT
    }

    #[inline(always)]
    pub(super) fn waits(self, is_compared: bool) -> bool {
        let bit = if is_compared {
            Self::COMPARED
        } else {
            Self::UNCOMPARED
        };
        self.0 & bit != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_byte_keeps_role_light_and_when() {
        let glass = Some(Blend::filter(100));
        for light in 0..Shadow::LIGHTS {
            for (role, is_hidden) in [
                (Role::Front(light), true),
                (Role::Back(light), true),
                (Role::Lit(light), false),
                (Role::Shadowed(light), true),
            ] {
                for blend in [None, glass] {
                    let late = Late::of(role, blend);
                    assert_eq!(late.role(), role);
                    assert!(late.waits(true) && !late.is_translucent());
                    assert_eq!(late.waits(false), is_hidden);
                    let turned = match role {
                        Role::Front(light) => Role::Back(light),
                        other => other,
                    };
                    assert_eq!(late.turned(), Late::of(turned, blend));
                }
            }
        }
        let late = Late::of(Role::None, glass);
        assert!(late.is_translucent() && late.waits(true) && !late.waits(false));
        let opaque = Late::of(Role::None, None);
        assert!(!opaque.is_translucent() && !opaque.waits(true) && !opaque.waits(false));
        assert_eq!([late.role(), opaque.role()], [Role::None; 2]);
    }
}
