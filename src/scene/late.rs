//! Draw calls that are not drawn among what is opaque: what is translucent, and what has to do with shadows (K9, K11).

use super::{DepthFunction, DepthTest, Master, Shadow};

/// What triangles of a draw call have to do with shadows, or why else they are drawn after all that is opaque.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Role {
    /// Nothing.
    #[default]
    None,
    /// Nothing, but what is behind shines through.
    Translucent,
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
    pub(super) fn of(shadow: Option<Shadow>, is_blended: bool, master: Master) -> Self {
        match shadow.filter(|_| master.has(Master::DEPTH)) {
            None if is_blended => Self::Translucent,
            None => Self::None,
            Some(Shadow::Volume(light)) => Self::Front(light),
            Some(Shadow::Lit(light)) => Self::Lit(light),
            Some(Shadow::Shadowed(light)) => Self::Shadowed(light),
        }
    }

    /// How a call compares, which asks for `test`.
    pub(super) fn depth(self, test: DepthTest) -> DepthTest {
        let usual = match self {
            Self::None | Self::Translucent => return test,
            Self::Front(_) | Self::Back(_) => DepthFunction::NEARER,
            Self::Lit(_) | Self::Shadowed(_) => DepthFunction::EQUAL,
        };
        let is_usual = test == DepthTest::HIDES;
        let function = if is_usual { usual } else { test.colour_if };
        DepthTest::new(function).without_write()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Faces, Mesh};
    use crate::scene::{Blend, Draw, DrawState};

    /// The state of a call of this shadow and blend.
    fn state(shadow: Option<Shadow>, blend: Option<Blend>) -> DrawState<'static> {
        let mesh = Mesh::<i16> {
            positions: &[],
            normals: &[],
            colours: &[],
            faces: Faces::Triangles(&[]),
        };
        let draw = Draw {
            shadow,
            blend,
            ..Draw::new(mesh)
        };
        DrawState::new(0, &draw, Master::ALL)
    }

    #[test]
    fn a_state_keeps_role_light_and_when() {
        let glass = Some(Blend::filter(100));
        for light in 0..Shadow::LIGHTS {
            for (shadow, role, turned) in [
                (Shadow::Volume(light), Role::Front(light), Role::Back(light)),
                (Shadow::Lit(light), Role::Lit(light), Role::Lit(light)),
                (
                    Shadow::Shadowed(light),
                    Role::Shadowed(light),
                    Role::Shadowed(light),
                ),
            ] {
                for blend in [None, glass] {
                    let mut late = state(Some(shadow), blend);
                    for role in [role, turned, turned] {
                        assert_eq!(late.role, role);
                        assert!(late.waits() && !late.is_translucent());
                        late.turn();
                    }
                }
            }
        }
        let late = state(None, glass);
        assert!(late.is_translucent() && late.waits());
        let opaque = state(None, None);
        assert!(!opaque.is_translucent() && !opaque.waits());
        assert_eq!(late.role, Role::Translucent);
        assert_eq!(opaque.role, Role::None);
    }
}
