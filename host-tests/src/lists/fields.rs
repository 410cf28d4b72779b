//! Vertices of a model as fields of a list: where a form puts places, normals and texture places.

use crate::model::Model;
use scanbeam::list::FieldForm;

/// Where a form puts places: `centre + scale field / unit`.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    pub(super) form: FieldForm,
    pub(super) centre: [f32; 3],
    /// Size of 1.0 of the mesh in the model.
    pub(super) scale: f32,
}

impl Grid {
    /// The finest grid of a form that holds `reach` each way.
    pub(super) fn new(form: FieldForm, centre: [f64; 3], reach: f64) -> Self {
        let [most, unit, _] = Self::limits(form)[0];
        let reach = if reach > 0.0 { reach } else { 1.0 };
        // A little more, so that rounding to single precision cannot leave the range.
        let scale = (reach * unit / most * (1.0 + 1e-6)) as f32;
        Self {
            form,
            centre: centre.map(|c| c as f32),
            scale,
        }
    }

    /// For each axis the largest field, the field of 1.0, and the field's least.
    fn limits(form: FieldForm) -> [[f64; 3]; 3] {
        match form {
            FieldForm::S8x3 => [[127.0, 128.0, -128.0]; 3],
            FieldForm::S10x3 => [
                // By the coarsest axis, so that one scale suits all.
                [1022.0, 1024.0, -1024.0],
                [1022.0, 1024.0, -1024.0],
                [511.0, 512.0, -512.0],
            ],
            FieldForm::S16x3 => [[32_767.0, 16_384.0, -32_768.0]; 3],
            _ => [[2_147_483_647.0, 1_073_741_824.0, -2_147_483_648.0]; 3],
        }
    }

    pub(super) fn fields(&self, p: [f64; 3]) -> [i32; 3] {
        let limits = Self::limits(self.form);
        [0, 1, 2].map(|i| {
            let [most, unit, least] = limits[i];
            let v = (p[i] - f64::from(self.centre[i])) / f64::from(self.scale) * unit;
            v.round().clamp(least, most) as i32
        })
    }

    pub(super) fn place(&self, fields: [i32; 3]) -> [f64; 3] {
        let limits = Self::limits(self.form);
        [0, 1, 2].map(|i| {
            f64::from(self.centre[i]) + f64::from(fields[i]) / limits[i][1] * f64::from(self.scale)
        })
    }
}

/// The fields of a normal, and what they mean, not yet of length 1.
pub(super) fn normal_fields(form: FieldForm, n: [f64; 3]) -> ([i32; 3], [f64; 3]) {
    let most = match form {
        FieldForm::S8x3 => [127.0; 3],
        FieldForm::S10x3 => [1023.0, 1023.0, 511.0],
        _ => [16_384.0; 3],
    };
    let fields = [0, 1, 2].map(|i| (n[i] * most[i]).round() as i32);
    (fields, [0, 1, 2].map(|i| f64::from(fields[i]) / most[i]))
}

pub(super) fn degrees_between(a: [f64; 3], b: [f64; 3]) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let lengths = (dot(a, a) * dot(b, b)).sqrt();
    if lengths == 0.0 {
        return 0.0;
    }
    (dot(a, b) / lengths).clamp(-1.0, 1.0).acos().to_degrees()
}

/// A vertex in fields.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Packed {
    pub(super) place: [i32; 3],
    pub(super) normal: [i32; 3],
    pub(super) colour: [u8; 3],
    /// Sides of the texture in 4.12, downwards; 0 where there is none.
    pub(super) uv: [u16; 2],
}

/// Texture places, moved by whole sides: a picture that repeats looks the same, and 2x16U holds
/// 0 ..< 16.
pub(super) struct Places {
    /// For all triangles, where one number does.
    together: Option<[f64; 2]>,
}

impl Places {
    const UNIT: f64 = 4096.0;
    const MOST: f64 = 65_535.0;

    /// Of some triangles' texture, which repeats or is clamped.
    pub(super) fn of(model: &Model, triangles: &[usize], clamped: bool) -> Self {
        if clamped {
            // Another side would be another place.
            return Self {
                together: Some([0.0; 2]),
            };
        }
        let corners = triangles.iter().flat_map(|n| model.triangles[*n]);
        let places: Vec<[f64; 2]> = corners.map(|v| model.vertices[v as usize].uv).collect();
        let whole = Self::sides(&places);
        let fits = |uv: &[f64; 2]| !Self::fields(*uv, whole).1;
        Self {
            together: places.iter().all(fits).then_some(whole),
        }
    }

    /// Whole sides that bring the least of some places to 0 ..= 1, downwards.
    fn sides(places: &[[f64; 2]]) -> [f64; 2] {
        let least = |of: fn(&[f64; 2]) -> f64| places.iter().map(of).fold(f64::INFINITY, f64::min);
        let [u, v] = [least(|p| p[0]), least(|p| 1.0 - p[1])];
        [u, v].map(|c| if c.is_finite() { c.floor() } else { 0.0 })
    }

    /// The fields of a place, and whether it was cut off.
    fn fields(uv: [f64; 2], sides: [f64; 2]) -> ([u16; 2], bool) {
        let down = [uv[0], 1.0 - uv[1]];
        let field = [0, 1].map(|i| ((down[i] - sides[i]) * Self::UNIT).round());
        let cut = field.iter().any(|f| !(0.0..=Self::MOST).contains(f));
        (field.map(|f| f.clamp(0.0, Self::MOST) as u16), cut)
    }

    /// The fields of a triangle's corners, and which of them were cut off.
    pub(super) fn moved(&self, corners: [[f64; 2]; 3]) -> [([u16; 2], bool); 3] {
        let sides = self.together.unwrap_or_else(|| Self::sides(&corners));
        corners.map(|uv| Self::fields(uv, sides))
    }
}
