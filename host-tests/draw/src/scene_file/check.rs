//! What a scene file may say, and what cannot be had together.

use super::{ApplicationKind, BlendKind, FormKind, Format, Item, SceneFile, ShadeKind, TexelsKind};
use crate::choice::MAX_SIDE;
use scene_flash::SOURCES;
use std::path::PathBuf;

/// Most objects of a scene.
const MAX_OBJECTS: usize = 1024;
/// Most lights.
const MAX_LIGHTS: usize = 8;
/// Most palettes, and most colours of one.
const MAX_PALETTES: usize = 256;

/// Surfaces of scenes with palettes.
const INDEXED: &str = "surfaces have an index there";
/// Surfaces of scenes with priorities.
const RANKED: &str = "what has priorities has no depth";

/// Texels without a picture.
const COMPUTED: &str = "there is no picture then";

/// What cannot be had together, and why: a word of an object, and another or one of its scene.
const APART: &[(&str, &str, &str)] = &[
    ("`texture`", "`palettes`", INDEXED),
    ("`filter`", "`palettes`", INDEXED),
    ("`levels`", "`palettes`", INDEXED),
    ("`quality`", "`palettes`", INDEXED),
    ("`application`", "`palettes`", INDEXED),
    ("`computed`", "`palettes`", INDEXED),
    ("`texels`", "`palettes`", INDEXED),
    ("`texel_form`", "`palettes`", INDEXED),
    ("`cached`", "`palettes`", INDEXED),
    ("`reflection`", "`palettes`", INDEXED),
    ("`shade`", "`palettes`", INDEXED),
    ("`blend`", "`palettes`", INDEXED),
    ("`channels`", "`palettes`", INDEXED),
    ("`depth`", "`palettes`", INDEXED),
    ("`writes_depth`", "`palettes`", INDEXED),
    ("`priority`", "`palettes`", INDEXED),
    ("`depth`", "`priority`", RANKED),
    ("`writes_depth`", "`priority`", RANKED),
    ("`computed`", "`texture`", "an object has one of them"),
    ("`computed`", "`levels`", COMPUTED),
    ("`computed`", "`texels`", COMPUTED),
    ("`computed`", "`texel_form`", COMPUTED),
    (
        "`window`",
        "`doubled`",
        "windows are in pixels of the picture",
    ),
    (
        "`texels` alpha",
        "`texel_form` compressed",
        "blocks have holes alone",
    ),
    (
        "`shade` none",
        "`specular`",
        "what is not lit has no highlights",
    ),
    (
        "`application` replace",
        "`specular`",
        "texels hide light there",
    ),
    ("`shadow`", "`blend`", "what is blended throws no shadow"),
    (
        "`channels`",
        "`shadows`",
        "surfaces in shadow are drawn whole",
    ),
    ("`alpha`", "`blend` half", "it takes half of each"),
    ("`alpha`", "`blend` factors", "they say how much is taken"),
    ("`texels` alpha", "`blend` half", "it takes half of each"),
    (
        "`source`",
        "`shadows`",
        "shadow volumes come through no queue",
    ),
    (
        "`writes_depth` false",
        "`shadows`",
        "they fall on what keeps its depth",
    ),
];

/// What an object says in vain without something else, of itself or of its scene.
const NEEDS: &[(&str, &str)] = &[
    ("`alpha`", "`blend`"),
    ("`index`", "`palettes`"),
    ("`texels` alpha", "`blend`"),
    ("`cached`", "`texel_form` compressed"),
    ("`shade` none", "`lights`"),
    ("`specular`", "`lights`"),
    ("`shininess`", "`specular`"),
    ("`shadow`", "`shadows`"),
];

/// What an object says of its pictures.
const OF_PICTURES: &[&str] = &[
    "`filter`",
    "`levels`",
    "`quality`",
    "`application`",
    "`texels`",
    "`texel_form`",
    "`reflection`",
];

/// What a scene cannot have together, and why.
const SCENE_APART: &[(&str, &str, &str)] = &[
    ("`palettes`", "`lights`", INDEXED),
    ("`palettes`", "`dither`", INDEXED),
    ("`palettes`", "`background`", INDEXED),
    ("`palettes`", "`doubled`", "indices have no mean"),
    ("`shadows`", "`priority`", "shadows are found by depth"),
];

/// What a scene says in vain without something else.
const SCENE_NEEDS: &[(&str, &str)] = &[("`ambient`", "`lights`"), ("`phong`", "`lights`")];

/// Words, and whether they are said.
struct Said<'w>(&'w [(&'static str, bool)]);

impl Said<'_> {
    fn has(&self, name: &str) -> bool {
        self.0.iter().any(|(said, is)| *is && *said == name)
    }
}

/// Holds words of `one` against words of `other`, or of itself.
fn hold(
    one: &Said<'_>,
    other: &Said<'_>,
    apart: &[(&str, &str, &str)],
    needs: &[(&str, &str)],
) -> Result<(), String> {
    let knows = |name: &str| other.0.iter().any(|(said, _)| *said == name);
    let is_said = |name: &str| match knows(name) {
        true => other.has(name),
        false => one.has(name),
    };
    let both = |(a, b, _): &&(&str, &str, &str)| one.has(a) && is_said(b);
    if let Some((a, b, why)) = apart.iter().find(both) {
        return Err(format!("{a} and {b} cannot be had together: {why}"));
    }
    let alone = |(a, b): &&(&str, &str)| one.has(a) && !is_said(b);
    match needs.iter().find(alone) {
        Some((a, b)) => Err(format!("{a} needs {b}")),
        None => Ok(()),
    }
}

impl SceneFile {
    /// Whether all that it says can be drawn.
    pub(super) fn check(&self) -> Result<(), String> {
        self.check_self()?;
        for (number, item) in self.objects.iter().enumerate() {
            let checked = self.check_item(item);
            checked.map_err(|why| format!("object {number}: {why}"))?;
        }
        Ok(())
    }

    /// What it says itself, and whether that is said.
    fn says(&self) -> [(&'static str, bool); 9] {
        [
            ("`palettes`", self.has_palettes()),
            ("`lights`", !self.lights.is_empty()),
            ("`ambient`", self.ambient.is_some()),
            ("`dither`", self.dither),
            ("`background`", self.background.is_some()),
            ("`priority`", self.has_priorities()),
            ("`phong`", self.phong),
            ("`doubled`", self.doubled),
            ("`shadows`", self.has_shadows()),
        ]
    }

    /// What is not of one object.
    fn check_self(&self) -> Result<(), String> {
        if !self.size.iter().all(|side| (1..=MAX_SIDE).contains(side)) {
            return Err(format!("`size` must be 1 to {MAX_SIDE} each way"));
        }
        self.view().check().map_err(|error| error.to_string())?;
        if self.objects.len() > MAX_OBJECTS {
            return Err(format!("at most {MAX_OBJECTS} `objects`"));
        }
        self.check_lights()?;
        let says = self.says();
        hold(&Said(&says), &Said(&says), SCENE_APART, SCENE_NEEDS)?;
        if self.dither && self.format != Format::Rgb565 && !self.has_palettes() {
            return Err("`dither` needs `format` rgb565".into());
        }
        if self.doubled && self.size.iter().any(|side| side % 2 != 0) {
            return Err("`doubled` needs an even `size`".into());
        }
        self.check_palettes()
    }

    fn check_lights(&self) -> Result<(), String> {
        if self.lights.len() > MAX_LIGHTS {
            return Err(format!("at most {MAX_LIGHTS} `lights`"));
        }
        let within = |value: &f64| (0.0..=1.0).contains(value);
        for lamp in &self.lights {
            if !is_finite(&lamp.towards) || lamp.towards == [0.0; 3] {
                return Err("`towards` of a light must be finite, and not zero".into());
            }
            if !lamp.colour.iter().all(within) {
                return Err("`colour` of a light must be from 0 to 1".into());
            }
        }
        if self.lights.iter().filter(|lamp| lamp.shadows).count() > 1 {
            return Err("at most one of the `lights` throws `shadows`".into());
        }
        match self.ambient.iter().all(within) {
            true => Ok(()),
            false => Err("`ambient` must be from 0 to 1".into()),
        }
    }

    fn check_palettes(&self) -> Result<(), String> {
        if !self.has_palettes() {
            return Ok(());
        }
        if self.palettes.len() > MAX_PALETTES {
            return Err(format!("at most {MAX_PALETTES} `palettes`"));
        }
        let sizes = 1..=MAX_PALETTES;
        if !(self.palettes.iter()).all(|p| sizes.contains(&p.colours.len())) {
            return Err(format!("a palette has 1 to {MAX_PALETTES} `colours`"));
        }
        let lines: Vec<u32> = self.palettes.iter().map(|p| p.from_line).collect();
        let rise = lines.windows(2).all(|pair| pair[0] < pair[1]);
        let last = lines.last().copied().unwrap_or(0);
        if lines.first() != Some(&0) || !rise || last >= self.size[1] {
            return Err(
                "`from_line` of palettes must begin at 0, rise, and stay below the height".into(),
            );
        }
        Ok(())
    }

    /// What one object says, against itself and the scene.
    fn check_item(&self, item: &Item) -> Result<(), String> {
        let names = [Some(&item.model), item.texture.as_ref()];
        let is_plain = |name: &&PathBuf| !name.to_string_lossy().contains(char::is_control);
        if !names.iter().flatten().all(is_plain) {
            return Err("names of files must not have control characters".into());
        }
        if item.scale.is_some_and(|s| !(is_finite(&[s]) && s > 0.0)) {
            return Err("`scale` must be above 0".into());
        }
        if !item.turn.iter().chain(&item.place).all(|v| is_finite(v)) {
            return Err("`turn` and `place` must be finite".into());
        }
        if let Some(computed) = &item.computed {
            computed.check()?;
        }
        let specular = item.specular.map_or([0.0; 3], Into::into);
        if !specular.iter().all(|level| (0.0..=1.0).contains(level)) {
            return Err("`specular` must be from 0 to 1".into());
        }
        if item.blend.is_some() && item.writes_depth == Some(true) {
            return Err("`blend` writes no depth: `writes_depth` cannot be true".into());
        }
        if item
            .source
            .is_some_and(|source| usize::from(source) >= SOURCES)
        {
            return Err(format!("`source` must be below {SOURCES}"));
        }
        if item.window.is_some_and(|w| w.width == 0 || w.height == 0) {
            return Err("`window` has no pixels".into());
        }
        let says = item.says();
        hold(&Said(&says), &Said(&self.says()), APART, NEEDS)
    }
}

impl Item {
    /// The first thing that it says of its pictures.
    pub(super) fn says_of_pictures(&self) -> Option<&'static str> {
        let said = |name: &&str| Said(&self.says()).has(name);
        OF_PICTURES.iter().copied().find(said)
    }

    /// What it says, and whether that is said.
    fn says(&self) -> Vec<(&'static str, bool)> {
        let keeps_none = self.blend.is_none() && self.writes_depth == Some(false);
        let is_compressed = self.texel_form == Some(FormKind::Compressed);
        let has_factors = matches!(self.blend, Some(BlendKind::Factors { .. }));
        let replaces = self.application == Some(ApplicationKind::Replace);
        vec![
            ("`texture`", self.texture.is_some()),
            ("`filter`", self.filter.is_some()),
            ("`levels`", self.levels.is_some()),
            ("`quality`", self.quality.is_some()),
            ("`application`", self.application.is_some()),
            ("`blend`", self.blend.is_some()),
            ("`blend` half", self.blend == Some(BlendKind::Half)),
            ("`blend` factors", has_factors),
            ("`alpha`", self.alpha.is_some()),
            ("`channels`", self.channels.is_some()),
            ("`depth`", self.depth.is_some()),
            ("`writes_depth`", self.writes_depth.is_some()),
            ("`priority`", self.priority.is_some()),
            ("`window`", self.window.is_some()),
            ("`index`", self.index.is_some()),
            ("`source`", self.source.is_some()),
            ("`computed`", self.computed.is_some()),
            ("`texels`", self.texels.is_some()),
            ("`texels` alpha", self.texels == Some(TexelsKind::Alpha)),
            ("`texel_form`", self.texel_form.is_some()),
            ("`texel_form` compressed", is_compressed),
            ("`cached`", self.cached.is_some()),
            ("`reflection`", self.reflection.is_some()),
            ("`shade`", self.shade.is_some()),
            ("`shade` none", self.shade == Some(ShadeKind::None)),
            ("`specular`", self.specular.is_some()),
            ("`shininess`", self.shininess.is_some()),
            ("`shadow`", self.shadow.is_some()),
            ("`writes_depth` false", keeps_none),
            ("`application` replace", replaces),
        ]
    }
}

/// Whether numbers are within those of single precision.
fn is_finite(v: &[f64]) -> bool {
    v.iter().all(|c| c.abs() <= f64::from(f32::MAX))
}
