//! The models and pictures that a scene names.

use super::{Item, SceneFile};
use crate::scenes::check;
use crate::{TextureSet, TextureSetError};
use host_support::model::{Model, ModelError};
use host_support::stdio;
use host_support::texture_file::TextureImage;
use std::path::{Path, PathBuf};

/// Why a scene cannot be loaded.
#[derive(Debug, thiserror::Error)]
pub enum SceneFileError {
    /// The file itself.
    #[error("{}: {reason}", file.display())]
    File {
        /// Its path.
        file: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A model.
    #[error("{0}")]
    Model(#[from] ModelError),
    /// The textures of a model.
    #[error("{}: {error}", file.display())]
    Textures {
        /// The model.
        file: PathBuf,
        /// What is wrong.
        error: TextureSetError,
    },
    /// An object that asks of its pictures what they are not.
    #[error("{}: object {number}: {reason}", file.display())]
    Object {
        /// The scene.
        file: PathBuf,
        /// Its number, from 0.
        number: usize,
        /// What is wrong.
        reason: String,
    },
}

/// An object of a scene with its model.
#[derive(Debug)]
pub struct Part {
    /// What the file says of it.
    pub item: Item,
    /// Its model.
    pub model: Model,
    /// The model's textures, of the file or of its materials.
    pub textures: TextureSet,
}

/// A scene with all that it names.
#[derive(Debug)]
pub struct Loaded {
    /// What the file says.
    pub scene: SceneFile,
    /// Its objects.
    pub parts: Vec<Part>,
    /// All files that it was read from.
    pub files: Vec<PathBuf>,
}

impl Loaded {
    /// Reads a scene, and what it names from the folder that it is in.
    ///
    /// # Errors
    /// The first file that cannot be read or is not what it should be.
    pub fn load(file: &Path) -> Result<Self, SceneFileError> {
        let wrong = |reason: String| SceneFileError::File {
            file: file.to_path_buf(),
            reason,
        };
        let text = std::fs::read_to_string(file)
            .map_err(|error| wrong(format!("cannot be read: {}", stdio::reason(&error))))?;
        let scene = SceneFile::parse(&text).map_err(wrong)?;
        let folder = file.parent().unwrap_or(Path::new(""));
        let (mut parts, mut files) = (Vec::new(), vec![file.to_path_buf()]);
        for (number, item) in scene.objects.iter().enumerate() {
            let named = |reason| SceneFileError::Object {
                file: file.to_path_buf(),
                number,
                reason,
            };
            let names = [
                ("model", Some(&item.model)),
                ("texture", item.texture.as_ref()),
            ];
            let is_nameless = |name: &PathBuf| name.as_os_str().is_empty();
            let mut nameless = names
                .iter()
                .filter(|(_, name)| name.is_some_and(is_nameless));
            if let Some((field, _)) = nameless.next() {
                return Err(named(format!("`{field}` needs a name")));
            }
            let part = Part::load(item, folder, scene.has_palettes())?;
            part.check().map_err(named)?;
            files.extend(part.model.files().map(Path::to_path_buf));
            files.extend(item.texture.iter().map(|picture| folder.join(picture)));
            parts.push(part);
        }
        Ok(Self {
            scene,
            parts,
            files,
        })
    }

    /// What is not as in the files, or is left out of them, a line each.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let mut notes: Vec<String> = Vec::new();
        for part in &self.parts {
            let of_model = part.model.warnings.iter().map(ToString::to_string);
            let of_textures = part.textures.notes().map(str::to_owned);
            let shines = |m: &host_support::model::Material| m.ks != [0.0; 3] || m.d < 1.0;
            let left_out = part.model.materials.iter().any(shines).then(|| {
                let file = part.item.model.display();
                format!(
                    "{file}: highlights and transparency of materials are left out: say `specular` and `blend`"
                )
            });
            for note in of_model.chain(of_textures).chain(left_out) {
                if !notes.contains(&note) {
                    notes.push(note);
                }
            }
        }
        notes
    }
}

impl Part {
    fn load(item: &Item, folder: &Path, indexed: bool) -> Result<Self, SceneFileError> {
        let file = folder.join(&item.model);
        let model = Model::load(&file)?;
        let textures = match indexed {
            true => Ok(TextureSet::default()),
            false => Self::textures(item, folder, &model),
        };
        let textures = textures.map_err(|error| SceneFileError::Textures { file, error })?;
        Ok(Self {
            item: item.clone(),
            model,
            textures: textures.with_levels(item.levels.unwrap_or(true)),
        })
    }

    /// The textures of a model: computed, of a file, or of its materials.
    fn textures(item: &Item, folder: &Path, model: &Model) -> Result<TextureSet, TextureSetError> {
        let set = match &item.computed {
            Some(computed) => TextureSet::whole(model, TextureImage::blank(computed.size())),
            None => {
                let picture = item.texture.as_ref().map(|picture| folder.join(picture));
                TextureSet::load_any(model, picture.as_deref())?
            }
        };
        match item.reflection {
            // Places are made of normals.
            Some(true) => Ok(set),
            _ => set.placed(model),
        }
    }

    /// Whether its pictures are what its fields ask of them.
    fn check(&self) -> Result<(), String> {
        let item = &self.item;
        let of_pictures = item.says_of_pictures();
        if let Some(field) = of_pictures.filter(|_| self.textures.is_empty()) {
            return Err(format!(
                "{field} needs `texture`, `computed`, or pictures of materials"
            ));
        }
        let images = self.textures.images();
        if item.texels.is_some() && images.iter().all(|image| image.alpha.is_none()) {
            return Err("`texels` needs a picture in which something is transparent".into());
        }
        images.iter().try_for_each(|image| check(item, image))
    }
}
