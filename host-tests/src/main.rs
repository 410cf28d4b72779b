//! The command line tool: see `scanbeam --help`.

use host_tests::args::InterpArg;
use host_tests::args::{self, Command, EXIT_BAD_INPUT, Method, PixelFormatArg, RenderArgs, Stop};
use host_tests::draw::{Drawn, TextureSet};
use host_tests::image_out::{Staged, encode_image};
use host_tests::lists::{bake, print as list_text, run as list_run};
use host_tests::model::Model;
use host_tests::scene_file::Loaded;
use host_tests::{
    accuracy, bench, boards, budgets, cache_report, compress, demo, draw, firmware_report, plan,
    report, stdio, tell, trace, view,
};
use scanbeam::frame::Paid;
use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

fn main() -> ExitCode {
    let command = match args::parse(std::env::args_os()) {
        Ok(command) => command,
        Err(Stop::Text(text)) => {
            stdio::out(format_args!("{text}"));
            return ended(Ok(ExitCode::SUCCESS));
        }
        Err(Stop::Refused(line)) => {
            tell!("{line}");
            return ExitCode::from(EXIT_BAD_INPUT);
        }
    };
    let done = match command {
        Command::Render(args) => render(&args),
        Command::View(args) => view::run(&args),
        Command::Trace(args) => trace::run(&args),
        Command::Demo(args) => demo::run(&args),
        Command::Cache(args) => cache_report::run(&args),
        Command::Accuracy(args) => accuracy::run(&args),
        Command::Budgets(args) => match budgets::run(&args) {
            // The limits were held against what is, and one is broken.
            Ok(false) => return ended(Ok(ExitCode::FAILURE)),
            Ok(true) => Ok(()),
            Err(error) => Err(error),
        },
        Command::Bench(args) => bench::run(&args),
        Command::Report(args) => report::run(&args),
        Command::Bake(args) => bake::run(&args),
        Command::Compress(args) => compress::run(&args),
        Command::RunList(args) => list_run::run(&args),
        Command::Disassemble(args) => list_text::run(&args),
        Command::Plan(args) => plan::run(&args),
        Command::Firmware(args) => match firmware_report::run(&args) {
            // The frames were compared and differ: bad firmware, not bad input.
            Ok(false) => return ended(Ok(ExitCode::FAILURE)),
            Ok(true) => Ok(()),
            Err(error) => Err(error),
        },
        Command::Boards(args) => match boards::run(&args) {
            Ok(false) => return ended(Ok(ExitCode::FAILURE)),
            Ok(true) => Ok(()),
            Err(error) => Err(error),
        },
    };
    ended(done.map(|()| ExitCode::SUCCESS))
}

/// The exit code of a command, unless what it said is lost.
fn ended(done: Result<ExitCode, Box<dyn Error>>) -> ExitCode {
    let done = done.and_then(|code| match stdio::lost() {
        Some(reason) => Err(reason.into()),
        None => Ok(code),
    });
    done.unwrap_or_else(|error| {
        tell!("error: {error}");
        ExitCode::from(EXIT_BAD_INPUT)
    })
}

/// A picture, and whether its texels have fewer levels than its pixels.
struct Picture {
    drawn: Drawn,
    is_rounded: bool,
}

impl Picture {
    /// With textures or without.
    fn new(drawn: Drawn, textured: bool, format: PixelFormatArg) -> Self {
        use PixelFormatArg::{Dithered565, Rgb565};
        Self {
            drawn,
            is_rounded: textured && !matches!(format, Rgb565 | Dithered565),
        }
    }

    /// Tells what is not as it was asked for.
    fn tell(&self, args: &RenderArgs) {
        if let Some(overfull) = &self.drawn.overfull {
            tell!("warning: {}: {overfull}", args.model.display());
        }
        if self.is_rounded {
            tell!("note: texels of textures are rounded to 5, 6 and 5 bits");
        }
        let untextured = self.drawn.used.assembled.untextured;
        if untextured > 0 {
            tell!(
                "note: triangles, or pieces of them, that stretch over more than 4096 texels, drawn without their texture: {untextured}"
            );
        }
        if let Some(paid) = self.drawn.paid.filter(|paid| paid.lines > 0) {
            let Paid {
                even,
                joined,
                unsorted,
                left_out,
                late,
                lost,
                ..
            } = paid;
            tell!(
                "note: {} lines would have cost too much: pixels of even runs {even}, of runs joined to others {joined}, \
                 not compared {unsorted}, left out {left_out}; triangles late {late}, lost {lost}",
                paid.lines
            );
        }
        if args.cache > draw::MOST_SLOTS {
            tell!(
                "note: a renderer's cache has at most {} slots: the picture is the same with any number",
                draw::MOST_SLOTS
            );
        }
    }
}

/// Textures as the flags ask for them.
fn skins<'s>(args: &RenderArgs, set: &'s TextureSet) -> draw::Skins<'s> {
    draw::Skins {
        set,
        filter: args.filter,
        budget: args.budget(),
    }
}

/// Writes a picture and, where they are asked for, its figures: both files, or none.
fn write(args: &RenderArgs, drawn: &Drawn) -> Result<(), Box<dyn Error>> {
    let picture = Staged::new(&args.output, &encode_image(&args.output, &drawn.frame)?)?;
    let Some(path) = &args.stats else {
        return Ok(picture.commit()?);
    };
    let mut text = serde_json::to_string_pretty(&drawn.to_json())?;
    text.push('\n');
    Ok(Staged::new(path, text.as_bytes())?.commit_with(picture)?)
}

/// Draws a scene file to a picture.
fn render_scene(args: &RenderArgs) -> Result<(), Box<dyn Error>> {
    let loaded = Loaded::load(&args.model)?;
    args.check_apart(loaded.files.iter().map(PathBuf::as_path))?;
    let file = args.model.display();
    let (view, format) = (loaded.scene.view(), loaded.scene.pixel_format());
    let drawn = draw::SceneParts::new(&loaded).and_then(|parts| {
        let drawn = draw::draw_scene_file(&parts, &view, format, args.crew())?;
        Ok(Picture::new(drawn, parts.are_textured(), format))
    });
    let picture = drawn.map_err(|error| format!("{file}: {error}"))?;
    write(args, &picture.drawn)?;
    for note in loaded.notes() {
        tell!("note: {note}");
    }
    picture.tell(args);
    Ok(())
}

/// Draws a model to a picture.
fn render(args: &RenderArgs) -> Result<(), Box<dyn Error>> {
    if args::is_scene(&args.model) {
        return render_scene(args);
    }
    let model = Model::load(&args.model)?;
    args.check_apart(model.files())?;
    let textures = match args.method() {
        // The hardware model has none.
        Method::Interp(InterpArg::Model) => TextureSet::default(),
        _ => TextureSet::load(&model, args.texture.as_deref())
            .map_err(|error| error.named(&args.model))?
            .with_levels(args.levels.is_on()),
    };
    if args.pace.is_some() && args.levels.is_on() && !textures.is_empty() {
        let model = args.model.display();
        return Err(format!("{model}: with --pace textures need --levels off").into());
    }
    let (view, format, crew) = (args.view(), args.format(), args.crew());
    let effects = args.effects();
    let are_seen = effects.are_seen(&model, &view);
    let drawn = match args.method() {
        Method::DrawCalls if are_seen => {
            let skins = skins(args, &textures);
            draw::draw_effects(&model, skins, (&view, format), crew, effects)
        }
        Method::DrawCalls => {
            draw::draw_textured(&model, skins(args, &textures), &view, format, crew)
        }
        method if !textures.is_empty() => return Err(format!("{method} draws no textures").into()),
        Method::Interp(interp) => draw::draw_by(&model, &view, format, crew, interp),
        Method::Depth(depth) => draw::draw_by_depth(&model, &view, format, crew, depth),
    };
    let drawn = drawn.map_err(|error| format!("{}: {error}", args.model.display()))?;
    let picture = Picture::new(drawn, !textures.is_empty(), format);
    write(args, &picture.drawn)?;
    // Last, so that a refusal is one line alone.
    model.print_warnings();
    if are_seen && args.method() != Method::DrawCalls {
        tell!(
            "note: with {}, highlights and transparency of materials are left out",
            args.method()
        );
    }
    for note in textures.notes() {
        tell!("note: {note}");
    }
    picture.tell(args);
    Ok(())
}
