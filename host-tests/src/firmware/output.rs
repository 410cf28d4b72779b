//! What the firmware prints, read totally: a line that it does not document is an error that names it.

use super::FirmwareError;
use std::collections::BTreeMap;

/// One frame that the firmware drew.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameResult {
    /// The scene's name.
    pub scene: String,
    /// CRC-32 (PNG's) of the frame's bytes in scan-out order.
    pub crc: u32,
    /// Instructions to draw it, exact to 40; hashing is not in them.
    pub instructions: u64,
}

/// The firmware's instruction counter, held against a loop of known length.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CountCheck {
    /// Which loop.
    pub name: String,
    /// Instructions that it has.
    pub expected: u64,
    /// Instructions that were counted.
    pub counted: u64,
    /// Whether the firmware finds the difference small enough; if not it also exits with 1.
    pub ok: bool,
}

/// A kernel that drew spans of about one length.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KernelRun {
    /// Which kernel.
    pub name: String,
    /// Pixels that it drew.
    pub pixels: u64,
    /// Spans that they were in.
    pub spans: u64,
    /// Instructions for all of them, exact to 40.
    pub instructions: u64,
}

/// How much one more of something costs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnitRun {
    /// Of what.
    pub name: String,
    /// How many there were more.
    pub count: u64,
    /// Instructions that they took.
    pub instructions: u64,
}

/// What each line of a scene costs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LinesRun {
    /// The scene's name.
    pub scene: String,
    /// Instructions before the first line.
    pub pass_one: u64,
    /// Instructions of each line.
    pub costs: Vec<u64>,
}

/// A sphere of so many triangles.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GrowthRun {
    /// Slots of the cache.
    pub slots: u64,
    /// Triangles submitted.
    pub triangles: u64,
    /// Objects that were filed.
    pub objects: u64,
    /// Instructions of pass one.
    pub pass_one: u64,
    /// Instructions of all lines.
    pub pass_two: u64,
}

/// Everything that the firmware prints, in order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Output {
    /// The frames.
    pub frames: Vec<FrameResult>,
    /// The checks of the counter.
    pub counts: Vec<CountCheck>,
    /// The kernels, each once with long and once with short spans; with the feature `bench` only.
    pub kernels: Vec<KernelRun>,
    /// Single things; with the feature `bench` only, as all that follow but `figures`.
    pub units: Vec<UnitRun>,
    /// Scenes line by line.
    pub lines: Vec<LinesRun>,
    /// Spheres.
    pub growth: Vec<GrowthRun>,
    /// Other figures by name, such as `stack_bytes`.
    pub figures: BTreeMap<String, u64>,
}

impl Output {
    /// Reads the lines that `host-tests/firmware` documents, of which the last is `done`.
    ///
    /// # Errors
    ///
    /// [`FirmwareError::Output`] at the first line that is not one of them, or where frames are
    /// missing at the end.
    pub fn parse(lines: &[String]) -> Result<Self, FirmwareError> {
        let mut output = Self::default();
        let mut done = false;
        for (index, line) in lines.iter().enumerate() {
            let result = if done {
                Err("comes after `done`".to_owned())
            } else {
                output.line(line)
            };
            done = result.map_err(|reason| FirmwareError::Output {
                number: index + 1,
                line: line.clone(),
                reason,
            })?;
        }
        if done {
            return Ok(output);
        }
        Err(FirmwareError::Output {
            number: lines.len() + 1,
            line: String::new(),
            reason: "ends without `done`".to_owned(),
        })
    }

    /// Takes one line in; true if it was the last.
    fn line(&mut self, line: &str) -> Result<bool, String> {
        let mut words = line.split_whitespace();
        let kind = words.next().unwrap_or_default();
        let mut fields = Fields::parse(words)?;
        match kind {
            "frame" => self.frames.push(FrameResult {
                scene: fields.take("scene")?.to_owned(),
                crc: fields.number("crc", 16)?,
                instructions: fields.number("instructions", 10)?,
            }),
            "count" => self.counts.push(CountCheck {
                name: fields.take("name")?.to_owned(),
                expected: fields.number("expected", 10)?,
                counted: fields.number("counted", 10)?,
                ok: fields.number::<u64>("ok", 10)? == 1,
            }),
            "kernel" => self.kernels.push(KernelRun {
                name: fields.take("name")?.to_owned(),
                pixels: fields.number("pixels", 10)?,
                spans: fields.number("spans", 10)?,
                instructions: fields.number("instructions", 10)?,
            }),
            "unit" => self.units.push(UnitRun {
                name: fields.take("name")?.to_owned(),
                count: fields.number("count", 10)?,
                instructions: fields.number("instructions", 10)?,
            }),
            "lines" => self.row_of_lines(&mut fields)?,
            "growth" => self.growth.push(GrowthRun {
                slots: fields.number("slots", 10)?,
                triangles: fields.number("triangles", 10)?,
                objects: fields.number("objects", 10)?,
                pass_one: fields.number("pass_one", 10)?,
                pass_two: fields.number("pass_two", 10)?,
            }),
            "figure" => {
                let name = fields.take("name")?.to_owned();
                let value = fields.number("value", 10)?;
                if self.figures.insert(name, value).is_some() {
                    return Err("this figure came before".to_owned());
                }
            }
            "done" => {
                let frames: usize = fields.number("frames", 10)?;
                if frames != self.frames.len() {
                    return Err(format!("{} frames came", self.frames.len()));
                }
            }
            _ => return Err("no line begins with this word".to_owned()),
        }
        fields.end()?;
        Ok(kind == "done")
    }

    /// Takes in a row of a scene's lines, the first of a scene or the one after the last.
    fn row_of_lines(&mut self, fields: &mut Fields<'_>) -> Result<(), String> {
        let (scene, pass_one) = (fields.take("scene")?, fields.number("pass_one", 10)?);
        let first: usize = fields.number("first", 10)?;
        let costs = fields.take("costs")?.split(',');
        let costs = costs
            .map(|cost| cost.parse::<u64>())
            .collect::<Result<Vec<_>, _>>()
            .map_err(|error| format!("`costs`: {error}"))?;
        if first == 0 {
            self.lines.push(LinesRun {
                scene: scene.to_owned(),
                pass_one,
                costs,
            });
            return Ok(());
        }
        match self.lines.last_mut() {
            Some(run) if run.scene == scene && run.costs.len() == first => {
                run.costs.extend(costs);
                Ok(())
            }
            _ => Err("the lines before these did not come".to_owned()),
        }
    }
}

/// The `key=value` words of a line, each to be taken once.
struct Fields<'a>(BTreeMap<&'a str, &'a str>);

impl<'a> Fields<'a> {
    fn parse(words: impl Iterator<Item = &'a str>) -> Result<Self, String> {
        let mut fields = BTreeMap::new();
        for word in words {
            let (key, value) = word
                .split_once('=')
                .ok_or_else(|| format!("`{word}` is not key=value"))?;
            if fields.insert(key, value).is_some() {
                return Err(format!("`{key}` is there twice"));
            }
        }
        Ok(Self(fields))
    }

    fn take(&mut self, key: &str) -> Result<&'a str, String> {
        self.0.remove(key).ok_or_else(|| format!("no `{key}`"))
    }

    fn number<N: TryFrom<u64>>(&mut self, key: &str, radix: u32) -> Result<N, String> {
        let text = self.take(key)?;
        u64::from_str_radix(text, radix)
            .ok()
            .and_then(|number| N::try_from(number).ok())
            .ok_or_else(|| format!("`{key}` is not a number in base {radix} that fits"))
    }

    fn end(self) -> Result<(), String> {
        match self.0.keys().next() {
            Some(key) => Err(format!("`{key}` is not expected")),
            None => Ok(()),
        }
    }
}
