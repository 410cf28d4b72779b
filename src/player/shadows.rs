//! Shadows that what a list draws casts (K9). Their code is in a program only where it calls
//! [`Player::with_shadows`](crate::input::Player::with_shadows).

use super::gather::Gathered;
use super::state::Drawer;
use crate::geometry::{Coordinate, ShadowMemory};
use crate::list::Place;
use crate::look::Look;

/// Memory for a volume at a time.
pub(super) struct Casts<'m, 't, L, C> {
    pub(super) memory: ShadowMemory<'m>,
    /// By a pointer that only `with_shadows` makes: what no program makes, no program has.
    pub(super) cast: Cast<'t, L, C>,
}

type Cast<'t, L, C> = fn(&mut Drawer<'_, '_, '_, 't, L, C>, &Gathered<'_, C>, &mut ShadowMemory);

/// Draws the shadow volumes of a mesh.
pub(super) fn cast<L: Look, C: Coordinate + Place>(
    drawer: &mut Drawer<'_, '_, '_, '_, L, C>,
    gathered: &Gathered<'_, C>,
    memory: &mut ShadowMemory<'_>,
) {
    for light in drawer.settings.casting() {
        let Some(scene) = &mut drawer.scene else {
            return;
        };
        let lent = ShadowMemory {
            edges: memory.edges,
            positions: memory.positions,
            faces: memory.faces,
        };
        let before = scene.assembled();
        let model = &drawer.state.draw.model;
        let done = scene.draw_shadow(&gathered.mesh, model, light, lent);
        drawer.count(0, before, done, gathered.block);
    }
}
