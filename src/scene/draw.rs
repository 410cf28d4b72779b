//! What a draw call says, and what pass two needs of it.

use super::alpha::Alphas;
use super::form::Square;
use super::late::Role;
use super::texgen::TexGen;
use super::{Blend, Budget, DepthTest, Lights, Master, Scissor, Shadow, Texture};
use crate::geometry::{Affine, Cull, Light, Mesh, PixelLamps};
use core::cell::Cell;
use core::ops::Range;

/// One draw call: a mesh, where it stands and how it looks.
///
/// `C` is the coordinate type of the mesh, as in [`Mesh`].
#[derive(Clone, Copy, Debug)]
pub struct Draw<'a, 't, C = i16> {
    /// What is drawn.
    pub mesh: Mesh<'a, C>,
    /// Model space to world space.
    pub model: Affine,
    /// Which faces are dropped.
    pub cull: Cull,
    /// The light, where the mesh is to be lit; it needs normals.
    pub light: Option<Light>,
    /// Several lights and the material that they fall on, in place of the one: a [`Lighting`](crate::light::Lighting).
    pub lights: Option<&'a dyn Lights>,
    /// What shines on pixels, for [`Phong`](crate::look::Phong) and [`TexturedPhong`](crate::look::TexturedPhong) alone, in
    /// place of the other two and of colours of corners. It is what the camera sees: to be made anew when that moves, and the scene with it.
    pub lamps: Option<&'t PixelLamps>,
    /// Where a face's colour comes from.
    pub shading: Shading,
    /// Colour of vertices that have none of their own.
    pub colour: [u8; 3],
    /// The texture, which looks without one refuse; colours and light are multiplied
    /// with it.
    pub texture: Option<Skin<'a, 't>>,
    /// How places on the texture are made of vertices, in place of those of the skin: reflections.
    pub texgen: Option<TexGen>,
    /// What the texture does to the colours.
    pub application: Application,
    /// The rectangle that it is cut to, or that is cut out of it.
    pub scissor: Option<Scissor>,
    /// Where it is seen and where its depth is kept, by how that compares.
    pub depth: DepthTest,
    /// What becomes of the colours that are there; `None` hides them.
    pub blend: Option<Blend>,
    /// The alpha of each vertex, 255 for 1, linear on the screen between them (K11); none, or as many as there are
    /// positions, or corners of triangles on the screen. It multiplies that of a [`Blend`] which has one, or is a factor
    /// of it; without a blend, or in one that asks for no alpha, it does nothing.
    ///
    /// In the scene's memory of vertices 8 alphas take the room of one vertex.
    pub alphas: &'a [u8],
    /// Whether its colours are dithered to pixels of 16 bits, by a 4 x 4 order over the picture: their mean over 16 pixels
    /// is nearer to the colour than a pixel can be. Pixels of 24 and 32 bits are not, nor are texels in full light.
    pub dither: bool,
    /// What it has to do with the shadows of a light: it bounds a volume, or is seen again where that light reaches it
    /// or does not. Renderers [`with_shadows`](crate::frame::Renderer::with_shadows) draw it.
    pub shadow: Option<Shadow>,
    /// The order in which it is drawn: a higher priority over a lower one, and among equal ones in order of
    /// submission. Where any call has one above 0, the whole scene is drawn so, and depth decides on nothing; no call
    /// may have a shadow then.
    pub priority: u8,
}

/// Where the colour of a face comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// From its vertices, and linear between them.
    #[default]
    Smooth,
    /// One colour: that of its first vertex, or of the call, lit by the normal of the face itself, which the mesh
    /// need not have.
    ///
    /// Each face that is kept takes three vertices of its own in memory, beside those of the mesh.
    Flat,
}

/// What a texture does to the colours of a mesh (H8).
///
/// Texels that are [transparent](Texture::keyed) are holes, in which what is behind is seen and no depth is kept; but
/// for [`Decal`](Application::Decal), which has none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Application {
    /// The texel times the colour, which light has fallen on.
    #[default]
    Product,
    /// The texel as it is: colours and light do nothing.
    Replace,
    /// The texel as it is, and the colour where the texel is transparent.
    Decal,
}

/// How a texture lies on a mesh.
#[derive(Clone, Copy, Debug)]
pub struct Skin<'a, 't> {
    /// The texture.
    pub texture: &'t Texture<'t>,
    /// The place of each vertex on it: to the right and down from its upper left corner, in texels with 8 fraction
    /// bits, -2^17 to 2^17 texels; beyond, modulo 2^18 texels, which is the same where the
    /// texture repeats. As many as there are positions.
    ///
    /// A triangle may stretch over 4,096 texels; one that stretches farther is drawn without the texture, and counted as
    /// [`untextured`](super::Assembled::untextured). From 2^18 - 4,096 texels on it is not told from a narrow one.
    pub places: &'a [[i32; 2]],
    /// How far a pixel's texel may be from its place.
    pub budget: Budget,
}

impl<'a, C> Draw<'a, '_, C> {
    /// A mesh at the origin, white, not lit, faces seen from behind dropped.
    #[must_use]
    pub const fn new(mesh: Mesh<'a, C>) -> Self {
        Self {
            mesh,
            model: Affine::IDENTITY,
            cull: Cull::Back,
            light: None,
            lights: None,
            lamps: None,
            shading: Shading::Smooth,
            colour: [255; 3],
            texture: None,
            texgen: None,
            application: Application::Product,
            scissor: None,
            depth: DepthTest::HIDES,
            blend: None,
            alphas: &[],
            dither: false,
            shadow: None,
            priority: 0,
        }
    }

    /// Whether it bounds a shadow, which is seen from all sides, wherever it is.
    pub(crate) fn is_volume(&self) -> bool {
        matches!(self.shadow, Some(Shadow::Volume(_)))
    }

    /// Whether faces that are turned away are dropped.
    pub(crate) fn is_one_sided(&self) -> bool {
        self.cull == Cull::Back && !self.is_volume()
    }
}

impl<'a, 't> Draw<'a, 't> {
    /// The same of another mesh.
    #[inline(always)]
    pub(crate) fn with_mesh<'b, C>(&self, mesh: Mesh<'b, C>) -> Draw<'b, 't, C>
    where
        'a: 'b,
    {
        Draw {
            mesh,
            model: self.model,
            cull: self.cull,
            light: self.light,
            lights: self.lights,
            lamps: self.lamps,
            shading: self.shading,
            colour: self.colour,
            texture: self.texture,
            texgen: self.texgen,
            application: self.application,
            scissor: self.scissor,
            depth: self.depth,
            blend: self.blend,
            alphas: self.alphas,
            dither: self.dither,
            shadow: self.shadow,
            priority: self.priority,
        }
    }
}

/// The states of a scene's draw calls.
#[derive(Clone, Debug)]
pub struct Draws<'a> {
    pub(crate) states: &'a [DrawState<'a>],
    /// How many calls have begun up to the object that was asked for last: mostly as many as up to the next one.
    begun: Cell<usize>,
}

impl<'a> Draws<'a> {
    #[inline(always)]
    pub(crate) fn new(states: &'a [DrawState<'a>]) -> Self {
        let begun = Cell::new(0);
        Self { states, begun }
    }

    /// How many calls have begun up to an object.
    #[inline(always)]
    pub(crate) fn begun(&self, object: u16) -> usize {
        let last = self.begun.get();
        let has = |number: usize| self.states.get(number).is_some_and(|d| d.first <= object);
        if last > 0 && has(last - 1) && !has(last) {
            return last;
        }
        let begun = DrawState::begun(object, self.states);
        self.begun.set(begun);
        begun
    }

    /// The number of the state of an object's call: that of the last call that began at it or before.
    #[inline(always)]
    pub(crate) fn number_of(&self, object: u16) -> u16 {
        if self.states.len() < 2 {
            return 0;
        }
        self.begun(object).saturating_sub(1) as u16
    }

    /// That state.
    #[inline(never)]
    pub(crate) fn state(&self, object: u16) -> Option<&'a DrawState<'a>> {
        self.states.get(self.begun(object).checked_sub(1)?)
    }
}

/// What pass two needs of a draw call, kept once a call.
#[derive(Clone, Copy, Debug, Default)]
pub struct DrawState<'t> {
    /// The number of its first triangle.
    pub(crate) first: u16,
    pub(crate) texture: Option<&'t Texture<'t>>,
    pub(crate) budget: Budget,
    pub(crate) scissor: Option<Scissor>,
    pub(crate) depth: DepthTest,
    pub(crate) blend: Option<Blend>,
    /// Where its vertices have their alphas, if they have any that are looked at.
    pub(crate) alphas: Option<Alphas>,
    pub(crate) dithers: bool,
    /// Whether its texture has a mask that is looked at.
    pub(crate) has_mask: bool,
    pub(crate) priority: u8,
    /// What it has to do with shadows.
    pub(crate) role: Role,
    /// The colour that light at pixels falls on, and that light.
    pub(crate) colour: [u8; 3],
    pub(crate) lamps: Option<&'t PixelLamps>,
    /// What transparent texels are, if there may be any.
    pub(crate) holes: Option<Holes>,
    /// The texture's rows, if it is one of the squares that have loops of their own.
    pub(crate) square: Option<Square<'t>>,
}

/// The texels of a draw call that are transparent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Holes {
    /// Their word.
    pub(crate) key: u16,
    /// Whether the colour of the triangle fills them, and is seen nowhere else.
    pub(crate) are_filled: bool,
}

impl Holes {
    /// A bit for each of up to 32 texels that is not transparent, the first the top one.
    #[inline(always)]
    pub(crate) fn opaque(self, texels: &[u16]) -> u32 {
        texels.iter().rev().fold(0, |bits, &texel| {
            bits >> 1 | u32::from(texel != self.key) << 31
        })
    }
}

impl<'t> DrawState<'t> {
    /// What fresh memory is filled with.
    pub const EMPTY: Self = Self {
        first: 0,
        texture: None,
        budget: Budget::BALANCED,
        scissor: None,
        depth: DepthTest::HIDES,
        blend: None,
        alphas: None,
        dithers: false,
        has_mask: false,
        priority: 0,
        role: Role::None,
        colour: [0; 3],
        lamps: None,
        holes: None,
        square: None,
    };

    /// That of a call whose first triangle has this number.
    pub(crate) fn new<C>(first: u16, draw: &Draw<'_, 't, C>, master: Master) -> Self {
        let skin = draw.texture.filter(|_| master.has(Master::TEXTURE));
        let texture = skin.map(|skin| skin.texture);
        let blend = draw.blend.filter(|_| master.has(Master::BLEND));
        let dithers = draw.dither && master.has(Master::DITHER);
        let is_blended = blend.is_some_and(|blend| blend.is_translucent());
        let role = Role::of(draw.shadow, is_blended, master);
        let depth = role.depth(draw.depth);
        Self {
            first,
            texture,
            budget: skin.map_or(Self::EMPTY.budget, |skin| skin.budget),
            scissor: draw.scissor,
            depth: match is_blended {
                _ if !master.has(Master::DEPTH) => DepthTest::HIDES,
                true => depth.without_write(),
                false => depth,
            },
            blend,
            alphas: None,
            dithers,
            has_mask: (dithers || is_blended) && texture.is_some_and(|t| t.mask.is_some()),
            priority: draw.priority,
            role,
            colour: draw.colour,
            lamps: draw.lamps.filter(|_| master.has(Master::SHADING)),
            holes: texture.and_then(Texture::key).map(|key| Holes {
                key,
                are_filled: draw.application == Application::Decal,
            }),
            square: texture.and_then(Texture::plain_square),
        }
    }

    /// How many calls began at an object or before.
    #[cold]
    #[inline(never)]
    fn begun(object: u16, draws: &[Self]) -> usize {
        draws.partition_point(|draw| draw.first <= object)
    }

    /// Whether its triangles are drawn in another way than most.
    pub(crate) fn has_values(&self) -> bool {
        self.dithers || self.rules()
    }

    /// Whether lines with its triangles are: what is dithered alone takes other colours, and hides like any other.
    pub(crate) fn rules(&self) -> bool {
        self.scissor.is_some() || self.compares() || self.holes.is_some() || self.has_mask
    }

    /// Whether pixels of a span are not all alike: there may be holes, or alphas.
    #[inline(always)]
    pub(crate) fn is_by_pixel(&self) -> bool {
        self.holes.is_some() || self.has_alphas()
    }

    /// Whether pixels of a span have alphas, or texels that say anything else of themselves.
    #[inline(always)]
    pub(crate) fn has_alphas(&self) -> bool {
        self.alphas.is_some() || self.has_mask
    }

    /// Whether its pixels do anything else than hide what is behind them.
    pub(crate) fn compares(&self) -> bool {
        self.blend.is_some() || self.depth != DepthTest::HIDES
    }

    /// Whether what is behind shines through, and it is drawn after all that is opaque.
    #[inline(always)]
    pub(crate) fn is_translucent(&self) -> bool {
        self.role == Role::Translucent
    }

    /// Whether it is drawn after all that is opaque, where depth is compared.
    #[inline(always)]
    pub(crate) fn waits(&self) -> bool {
        self.role != Role::None
    }

    /// Whether nothing is to be seen of it where nothing is counted.
    #[inline(never)]
    pub(crate) fn is_in_vain(&self) -> bool {
        !matches!(self.role, Role::None | Role::Translucent | Role::Lit(_))
    }

    /// Says that a volume's triangles are seen from inside.
    pub(super) fn turn(&mut self) {
        if let Role::Front(light) = self.role {
            self.role = Role::Back(light);
        }
    }

    /// The columns of a line that are kept, from left to right; either run may be empty.
    pub(crate) fn cut(&self, line: u32, columns: Range<u32>) -> [Range<u32>; 2] {
        match &self.scissor {
            Some(scissor) => scissor.cut(line, columns),
            None => [columns.clone(), columns.end..columns.end],
        }
    }

    /// The texture, if there is one, and how exact it is.
    #[inline(always)]
    pub(crate) fn texture(&self) -> Option<(&'t Texture<'t>, Budget)> {
        Some((self.texture?, self.budget))
    }
}
