//! Which scenes have their instructions reckoned: those whose draw calls have nothing but colours, lights and textures.
//! Of lists those whose tables have colours and lights: see [`Blocks`](crate::flashed::blocks::Blocks).

use super::samples::{LONGEST_SIDE, SHORTEST_SIDE};
use crate::scene_file::{Item, Loaded, SceneFile, ShadeKind};

/// Whether all textures of a scene are squares as those that costs were measured on.
#[must_use]
pub fn has_usual_textures(loaded: &Loaded) -> bool {
    let mut images = loaded.parts.iter().flat_map(|part| part.textures.images());
    images.all(|image| is_usual([image.width, image.height]))
}

fn is_usual([width, height]: [u32; 2]) -> bool {
    width == height && (SHORTEST_SIDE..=LONGEST_SIDE).contains(&width)
}

/// What a scene has of which no costs are on record; `None` where it has nothing.
#[must_use]
pub fn beyond(scene: &SceneFile) -> Option<&'static str> {
    // A field that this does not know does not compile.
    let SceneFile {
        size: _,
        format: _,
        dither,
        background: _,
        camera: _,
        ambient: _,
        lights,
        phong,
        doubled,
        palettes,
        objects,
    } = scene;
    let first = |all: &[(bool, &'static str)]| {
        let found = all.iter().find(|(has, _)| *has);
        found.map(|(_, what)| *what)
    };
    let of_scene = first(&[
        (*dither, "dither"),
        (*phong, "light at pixels"),
        (*doubled, "doubled pictures"),
        (!palettes.is_empty(), "palettes"),
        (lights.iter().any(|light| light.shadows), "shadows"),
    ]);
    of_scene.or_else(|| objects.iter().find_map(|object| first(&of_object(object))))
}

fn of_object(object: &Item) -> [(bool, &'static str); 15] {
    let Item {
        model: _,
        scale: _,
        turn: _,
        place: _,
        texture: _,
        computed,
        texels,
        texel_form,
        cached,
        reflection,
        filter,
        levels,
        quality,
        application,
        shade,
        specular,
        shininess: _,
        shadow: _,
        cull: _,
        blend,
        // It is of use with a blend alone.
        alpha: _,
        channels,
        depth,
        writes_depth,
        priority,
        window,
        // It is of use with palettes alone.
        index: _,
        source,
    } = object;
    [
        (computed.is_some(), "computed textures"),
        (texels.is_some(), "cutouts and alphas of textures"),
        (texel_form.is_some(), "textures in other forms"),
        (cached.is_some(), "caches of texels"),
        (reflection.is_some(), "reflections"),
        (filter.is_some(), "filters of textures"),
        (quality.is_some(), "qualities of textures"),
        (*levels == Some(false), "textures without levels"),
        (application.is_some(), "applications of textures"),
        (*shade == Some(ShadeKind::Flat), "flat faces"),
        (specular.is_some(), "highlights"),
        (blend.is_some() || channels.is_some(), "blends"),
        (depth.is_some() || writes_depth.is_some(), "tests of depth"),
        (
            priority.is_some() || source.is_some(),
            "an order of draw calls",
        ),
        (window.is_some(), "windows"),
    ]
}
