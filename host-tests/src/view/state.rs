//! What keys change, and the view that follows from it. Knows no terminal, so tests press keys.

use super::Scenery;
use crate::args::{PixelFormatArg, QualityArg, ViewArgs};
use crate::draw::MOST_SLOTS;
use crate::reference::{Cull, Shade, View};
use crate::scene_file::{Format, SceneFile};
use crossterm::event::KeyCode;
use std::f64::consts::TAU;

/// What keys do, for the last line of the screen.
pub const KEYS: &str = "Esc end  arrows orbit  +- nearer, farther  space stop  q quality  \
                        s shading  c cache  r renderers  f format";

/// Vertical field of view in degrees.
const FOV: f64 = 45.0;
/// How far an arrow turns, in radians.
const ARROW: f64 = TAU / 48.0;
/// How high and how low the eye goes, in radians from the horizon.
const STEEPEST: f64 = TAU / 4.0 - 0.05;
/// Nearest and farthest, in distances at which the whole model is seen.
const DISTANCES: std::ops::RangeInclusive<f64> = 0.3..=8.0;
/// Sizes of the cache, in slots.
const SLOTS: [u16; 5] = [0, 4, 16, 64, MOST_SLOTS];
/// Numbers of renderers.
const RENDERERS: [u16; 4] = [1, 2, 3, 4];

/// Whether to go on after a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// Draw the next frame.
    On,
    /// The key asked for the end.
    End,
}

/// Where the eye is, and how the model is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Turn of the eye about the model's vertical, in radians.
    pub yaw: f64,
    /// Height of the eye, in radians above the horizon.
    pub pitch: f64,
    /// Distance of the eye, 1 where the whole model is just seen.
    pub distance: f64,
    /// Whether the model turns by itself.
    pub spins: bool,
    /// How light is applied.
    pub shade: Shade,
    /// How far texture places may be off.
    pub quality: QualityArg,
    /// Slots of each renderer's object cache.
    pub slots: u16,
    /// Line renderers.
    pub renderers: u16,
    /// Pixel format.
    pub format: PixelFormatArg,
}

impl State {
    /// From a little above, turning, with what the flags say.
    #[must_use]
    pub fn new(args: &ViewArgs) -> Self {
        Self {
            yaw: 0.0,
            pitch: 0.35,
            distance: 1.0,
            spins: true,
            shade: args.shade,
            quality: args.quality,
            slots: args.cache,
            renderers: args.renderers,
            format: args.format,
        }
    }

    /// From where a scene's camera is, turning, in the scene's format.
    #[must_use]
    pub fn of_scene(args: &ViewArgs, scene: &SceneFile) -> Self {
        Self {
            pitch: 0.0,
            format: match scene.format {
                Format::Rgb888 => PixelFormatArg::Rgb888,
                Format::Rgb565 => PixelFormatArg::Rgb565,
            },
            ..Self::new(args)
        }
    }

    /// Turns on by itself, when it does.
    pub fn spin(&mut self, radians: f64) {
        if self.spins {
            self.yaw = (self.yaw + radians).rem_euclid(TAU);
        }
    }

    /// Does what a key says; other keys do nothing.
    pub fn key(&mut self, key: KeyCode) -> Step {
        let key = match key {
            KeyCode::Char(letter) => KeyCode::Char(letter.to_ascii_lowercase()),
            other => other,
        };
        match key {
            KeyCode::Esc | KeyCode::Char('x') => return Step::End,
            KeyCode::Left => self.yaw = (self.yaw - ARROW).rem_euclid(TAU),
            KeyCode::Right => self.yaw = (self.yaw + ARROW).rem_euclid(TAU),
            KeyCode::Up => self.pitch = (self.pitch + ARROW).min(STEEPEST),
            KeyCode::Down => self.pitch = (self.pitch - ARROW).max(-STEEPEST),
            KeyCode::Char('+' | '=') => self.go_to(self.distance / 1.1),
            KeyCode::Char('-' | '_') => self.go_to(self.distance * 1.1),
            KeyCode::Char(' ') => self.spins = !self.spins,
            KeyCode::Char('q') => {
                self.quality = match self.quality {
                    QualityArg::Fast => QualityArg::Balanced,
                    QualityArg::Balanced => QualityArg::Exact,
                    QualityArg::Exact => QualityArg::Fast,
                }
            }
            KeyCode::Char('s') => {
                self.shade = match self.shade {
                    Shade::None => Shade::Flat,
                    Shade::Flat => Shade::Gouraud,
                    Shade::Gouraud => Shade::None,
                }
            }
            KeyCode::Char('f') => {
                self.format = match self.format {
                    PixelFormatArg::Rgb565 => PixelFormatArg::Rgb888,
                    _ => PixelFormatArg::Rgb565,
                }
            }
            KeyCode::Char('c') => self.slots = next(&SLOTS, self.slots),
            KeyCode::Char('r') => self.renderers = next(&RENDERERS, self.renderers),
            _ => {}
        }
        Step::On
    }

    fn go_to(&mut self, distance: f64) {
        self.distance = distance.clamp(*DISTANCES.start(), *DISTANCES.end());
    }

    /// The choices, in one line.
    #[must_use]
    pub fn choices(&self) -> String {
        let (shade, quality, format) = (self.shade, self.quality, self.format);
        let renderers = if self.renderers == 1 { "" } else { "s" };
        format!(
            "{shade:?}, {quality:?}, {format:?}, {} slots, {} renderer{renderers}",
            self.slots, self.renderers
        )
        .to_lowercase()
    }

    /// The view of so many pixels. The light comes from the left above the eye.
    #[must_use]
    pub fn view(&self, scenery: &Scenery<'_>, width: u32, height: u32) -> View {
        if let Some(own) = scenery.own_view() {
            let eye = self.around(&own);
            return View {
                width,
                height,
                eye,
                ..own
            };
        }
        let (sin, cos) = self.yaw.sin_cos();
        let turned = |[x, y, z]: [f64; 3]| [x * cos + z * sin, y, z * cos - x * sin];
        // A narrow picture is left by the model at the sides first.
        let half = (FOV.to_radians() / 2.0).tan() * (f64::from(width) / f64::from(height)).min(1.0);
        let away = scenery.radius / half.atan().sin() * self.distance;
        let eye = turned([0.0, away * self.pitch.sin(), away * self.pitch.cos()]);
        View {
            width,
            height,
            eye: std::array::from_fn(|i| scenery.centre[i] + eye[i]),
            at: scenery.centre,
            fov: FOV,
            near: (away - 1.01 * scenery.radius).max(0.02 * away),
            far: away + 1.01 * scenery.radius,
            light: turned([-0.6, 0.9, 0.8]),
            shade: self.shade,
            cull: Cull::None,
            background: [24, 32, 48],
            ..View::default()
        }
    }
}

impl State {
    /// Where the eye of a scene's camera has gone: on the sphere around the place that it looks
    /// at, about what is up, by yaw; to its poles, by pitch; nearer or farther.
    fn around(&self, own: &View) -> [f64; 3] {
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let times = |a: [f64; 3], by: f64| a.map(|c| c * by);
        let unit = |a: [f64; 3]| times(a, 1.0 / dot(a, a).sqrt());
        let away: [f64; 3] = std::array::from_fn(|i| own.eye[i] - own.at[i]);
        let up = unit(own.up);
        let rise = dot(unit(away), up);
        let ahead = unit(std::array::from_fn(|i| away[i] - dot(away, up) * up[i]));
        let aside = [
            up[1] * ahead[2] - up[2] * ahead[1],
            up[2] * ahead[0] - up[0] * ahead[2],
            up[0] * ahead[1] - up[1] * ahead[0],
        ];
        let pitch = (rise.asin() + self.pitch).clamp(-STEEPEST, STEEPEST);
        let (level, far) = (pitch.cos(), dot(away, away).sqrt() * self.distance);
        std::array::from_fn(|i| {
            let turned = ahead[i] * self.yaw.cos() + aside[i] * self.yaw.sin();
            own.at[i] + far * (level * turned + pitch.sin() * up[i])
        })
    }
}

/// The one after `now`, or the first one.
fn next(of: &[u16], now: u16) -> u16 {
    of.iter().copied().find(|&one| one > now).unwrap_or(of[0])
}
