//! Draw calls that are not drawn among what is opaque: what is translucent, and what has to do with shadows (K9, K11).

use super::DepthFunction;
use super::{Blend, DepthTest, Master, Shadow};

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
            Some(shadow) if master.has(Master::DEPTH) => match shadow {
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

/// Whether a draw call is drawn later, and its role, in a byte: a draw state has room for one more.
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

    pub(super) fn of(role: Role, blend: Option<Blend>) -> Self {
        const { assert!(Shadow::LIGHTS - 1 == Self::LIGHT) };
        let (what, light) = match role {
            Role::None if blend.is_some_and(|blend| blend.is_translucent()) => {
                (Self::TRANSLUCENT, 0)
            }
            Role::None => return Self::NOT,
            Role::Front(light) => (Self::FRONT, light),
            Role::Back(light) => (Self::BACK, light),
            Role::Lit(light) => (Self::LIT, light),
            Role::Shadowed(light) => (Self::SHADOWED, light),
        };
        Self(what | light & Self::LIGHT)
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

    /// Whether it is drawn later, where depth is compared.
    #[inline(always)]
    pub(super) fn waits(self) -> bool {
        self != Self::NOT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_byte_keeps_role_light_and_when() {
        let glass = Some(Blend::filter(100));
        for light in 0..Shadow::LIGHTS {
            for role in [
                Role::Front(light),
                Role::Back(light),
                Role::Lit(light),
                Role::Shadowed(light),
            ] {
                for blend in [None, glass] {
                    let late = Late::of(role, blend);
                    assert_eq!(late.role(), role);
                    assert!(late.waits() && !late.is_translucent());
                    let turned = match role {
                        Role::Front(light) => Role::Back(light),
                        other => other,
                    };
                    assert_eq!(late.turned(), Late::of(turned, blend));
                }
            }
        }
        let late = Late::of(Role::None, glass);
        assert!(late.is_translucent() && late.waits());
        let opaque = Late::of(Role::None, None);
        assert!(!opaque.is_translucent() && !opaque.waits());
        assert_eq!([late.role(), opaque.role()], [Role::None; 2]);
    }
}
