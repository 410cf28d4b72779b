//! Baked lists in the rooms `scene`, `look` and `frame`: the teapot, and a crate with its textures (H7, H11), or with a
//! computed one in place of one of them (H17).

use crate::listed::{crate_list, teapot_list, teapot_meshlets_list};
use crate::{CRATE_INDICES, CRATE_TABLE, LIST_INDICES, LIST_TABLE, Shot};
use scanbeam::event::Notice;
use scanbeam::input::{Player, PlayerSettings, RunCounts};
use scanbeam::list::{Budget, Halt, ListCommand, ListError};
use scanbeam::look::Look;
use scanbeam::scene::{BeginError, Checker, Draw, Scene, Texture};
use scanbeam::{Affine, Camera, CameraError, Light};

/// A list that is played.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Played {
    /// The teapot, smooth and lit.
    Teapot,
    /// The same in parts.
    TeapotMeshlets,
    /// The crate, textured and lit.
    Crate,
    /// The same, with a texture of the application in place of its first one.
    CrateOwn,
}

/// Their names.
pub const PLAYED: [(&str, Played); 4] = [
    ("teapot_list", Played::Teapot),
    ("teapot_list_meshlets", Played::TeapotMeshlets),
    ("crate_list", Played::Crate),
    ("crate_list_own", Played::CrateOwn),
];

/// Squares in the panel's order of bytes.
static SQUARES: Checker = Checker {
    colours: [0x041F_u16.to_be(), 0xFFE0_u16.to_be()],
    log_side: 1,
};

static CHECKED: Texture<'static> = match Texture::computed(&SQUARES, 16, 16) {
    Ok(texture) => texture,
    Err(_) => panic!("powers of two"),
};
/// What the number 0 means.
static OWN: [Option<&Texture<'static>>; 1] = [Some(&CHECKED)];

/// Numbers of the crate's two textures and their palettes.
pub const PLAYED_NAMES: usize = 4;
/// The crate's textures that are drawn with.
pub const PLAYED_TEXTURES: usize = 2;
/// Words of their palettes.
pub const PLAYED_TEXELS: usize = 2 * 256;

/// Why a list was not played whole.
#[derive(Clone, Copy, Debug)]
pub enum PlayedError {
    /// The camera cannot be made.
    Camera(CameraError),
    /// The scene was not begun.
    Begin(BeginError),
    /// The list was refused.
    List(ListError),
    /// It halted before its end, or the scene is too small.
    Halted(Halt),
}

impl Played {
    /// The list, as it lies in flash.
    ///
    /// # Errors
    /// None: it is aligned.
    pub fn list(self) -> Result<&'static [u32], ListError> {
        match self {
            Self::Teapot => teapot_list(),
            Self::TeapotMeshlets => teapot_meshlets_list(),
            Self::Crate | Self::CrateOwn => crate_list(),
        }
    }

    /// Vertices of its largest table, and indices that are drawn together.
    #[must_use]
    pub const fn sizes(self) -> [usize; 2] {
        match self {
            Self::Teapot | Self::TeapotMeshlets => [LIST_TABLE, LIST_INDICES],
            Self::Crate | Self::CrateOwn => [CRATE_TABLE, CRATE_INDICES],
        }
    }

    /// How it begins: where [`Shot::Teapot`] stands, in its light.
    #[must_use]
    pub fn settings(self) -> PlayerSettings<'static, 'static> {
        let settings = PlayerSettings::default();
        PlayerSettings {
            textures: match self {
                Self::CrateOwn => &OWN,
                _ => &[],
            },
            draw: Draw {
                model: Affine::rotation_y(0.6),
                light: Light::new([0.3, 0.8, 0.6], 0.2),
                ..settings.draw
            },
            ..settings
        }
    }

    /// The camera that looks at it.
    ///
    /// # Errors
    /// None: it sees.
    pub fn camera(self) -> Result<Camera, CameraError> {
        let eye = match self {
            Self::Teapot | Self::TeapotMeshlets => [0.0, 1.2, 2.6],
            Self::Crate | Self::CrateOwn => [0.3, 1.7, 2.4],
        };
        Camera::look_at(eye, [0.0; 3], [0.0, 1.0, 0.0], 300.0, 0.1, 100.0)
    }

    /// What is behind it.
    #[must_use]
    pub fn background(self) -> [u8; 3] {
        Shot::Teapot.background()
    }

    /// Begins `scene` and plays the list into it, with a player that has [`settings`](Played::settings); `begin` says
    /// whether the list is looked at first.
    ///
    /// # Errors
    /// When the memory of the player or of the scene is too small.
    pub fn play<'t, L: Look>(
        self,
        player: &mut Player<'_, 't, L>,
        begin: ListCommand,
        scene: &mut Scene<'_, 't, L>,
    ) -> Result<RunCounts, PlayedError> {
        let list = self.list().map_err(PlayedError::List)?;
        let camera = self.camera().map_err(PlayedError::Camera)?;
        scene.begin(&camera).map_err(PlayedError::Begin)?;
        player.command(begin);
        let halt = player
            .run(list, scene, &mut Budget::of(1 << 16), &mut |_: Notice| {})
            .map_err(PlayedError::List)?;
        let counts = player.counts();
        match halt {
            Halt::End if counts.dropped == 0 => Ok(counts),
            halt => Err(PlayedError::Halted(halt)),
        }
    }
}
