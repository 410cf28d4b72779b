//! Floors and cubes whose texels are computed, and others whose texels lie in blocks of slow memory behind a small cache,
//! beside a crate of a list one of whose textures they are (H17, B1, B5).

use super::listed::{Rooms, wooden_crate};
use super::sampled::{cube, floor};
use super::scenes::{PANEL, at, draw_all, light};
use super::{DRAWS, Rest, ValuesError, background, values_screen};
use crate::ShotError;
use crate::TEXELS_F_PANEL;
use crate::looks::TexturedLook;
use scanbeam::Affine;
use scanbeam::frame::{FastMemory, Renderer, draw_frame};
use scanbeam::input::PlayerSettings;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::{LineBuf, Pump, ScanoutDma};
use scanbeam::scene::{
    BlockCache, Blocked, CacheWord, Checker, Draw, DrawState, Gradient, Sampling, Scene, Texels,
    Texture, Wrap,
};

static CHECKER: Checker = Checker {
    colours: [0xFFFF, 0x18E3_u16.to_be()],
    log_side: 3,
};

static GRADIENT: Gradient = Gradient {
    from: [250, 120, 0],
    to: [0, 40, 220],
    log_length: 5,
    word: Rgb565Be::from_rgb8,
};

const fn computed_of(texels: &'static dyn Texels, width: u32, height: u32) -> Texture<'static> {
    match Texture::computed(texels, width, height) {
        Ok(texture) => texture,
        Err(_) => panic!("powers of two"),
    }
}

static SQUARES: Texture<'static> = computed_of(&CHECKER, 64, 64);
/// Squares of white, and holes between them.
static HOLES: Texture<'static> = SQUARES.keyed(CHECKER.colours[1]);
static WAY: Texture<'static> = computed_of(&GRADIENT, 64, 1).wrapping(Wrap::Mirror);
static MIXED: Texture<'static> = match SQUARES.sampled(Sampling::LINEAR, &[]) {
    Ok(texture) => texture,
    Err(_) => panic!("it has no levels"),
};

/// Columns and rows of the texture in blocks: the upper half of that of scene F.
const SIDES: [u32; 2] = [64, 32];

/// Texels of slow memory, and fast memory for 8 blocks of 32 bytes.
pub(super) struct Slow {
    texels: [u16; (SIDES[0] * SIDES[1]) as usize],
    fast: [CacheWord; 8 * 16],
}

impl Slow {
    pub(super) const fn new() -> Self {
        Self {
            texels: [0; (SIDES[0] * SIDES[1]) as usize],
            fast: [const { CacheWord::new() }; 8 * 16],
        }
    }

    /// Lays the texels in blocks, and makes the cache.
    pub(super) fn cache(&mut self) -> Result<BlockCache<'_>, ShotError> {
        let layout = Blocked::of_page(32, 16);
        layout
            .arrange(SIDES, &TEXELS_F_PANEL, &mut self.texels)
            .map_err(ShotError::Texture)?;
        let slow = Texture::words(&self.texels, SIDES[0], SIDES[1]).map_err(ShotError::Texture)?;
        BlockCache::new(slow, layout, &mut self.fast).map_err(ShotError::Cache)
    }
}

/// Makes the scene of computed texels.
pub(super) fn computed(scene: &mut Scene<'_, 'static, TexturedLook>) -> Result<(), ShotError> {
    let calls = [
        floor(&SQUARES, -6.0),
        floor(&MIXED, 6.0),
        cube(&WAY, 0.5, [-0.1, 0.0, 1.2]),
        cube(&MIXED, 0.9, [0.8, 0.2, 0.8]),
        cube(&HOLES, 0.2, [-0.7, 0.3, 0.6]),
    ];
    draw_all(scene, &calls)
}

impl Rest<'_> {
    /// Lays texels in blocks, and sends the scene that reads them through a cache.
    #[inline(never)]
    pub(super) fn send_blocks<D>(
        self,
        cache: &mut FastMemory<TexturedLook>,
        pump: &mut Pump<D>,
    ) -> Result<(), ValuesError<D::Error>>
    where
        D: ScanoutDma<Buf: LineBuf<Word = u16>>,
    {
        let (mut slow, mut rooms) = (Slow::new(), Rooms::EMPTY);
        let texels = slow.cache()?;
        let cached = texels.texture();
        let mut draws = [const { DrawState::EMPTY }; DRAWS];
        let (memory, lines, _) = self.lend(&mut draws, cache);
        let mut scene = Scene::new(values_screen(), memory);
        blocks(&mut scene, &cached)?;
        let settings = PlayerSettings {
            textures: &[Some(&cached)],
            draw: Draw {
                model: Affine::rotation_y(0.7).then(&at(0.4, [0.5, 0.75, -0.6])),
                light: light(),
                ..PlayerSettings::default().draw
            },
            ..PlayerSettings::default()
        };
        wooden_crate(&mut scene, settings, &mut rooms)?;
        draw_frame(&scene, &mut Renderer::new(lines), pump, background(), 3)?;
        Ok(())
    }
}

/// Makes the scene of texels behind a cache, and of some that are not.
fn blocks<'t>(
    scene: &mut Scene<'_, 't, TexturedLook>,
    cached: &'t Texture<'t>,
) -> Result<(), ShotError> {
    let calls = [
        floor(cached, -6.0),
        floor(&PANEL, 6.0),
        cube(cached, 0.5, [-0.1, 0.0, 1.2]),
        cube(&PANEL, 0.9, [0.8, 0.2, 0.8]),
    ];
    draw_all(scene, &calls)
}
