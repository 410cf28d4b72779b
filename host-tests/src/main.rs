//! The command line tool: see `scanbeam --help`.

use host_tests::args::{
    self, Command, DepthArg, EXIT_BAD_INPUT, InterpArg, PixelFormatArg, QualityArg, RenderArgs,
    Stop,
};
use host_tests::draw::TextureSet;
use host_tests::image_out::{Frame, Staged, encode_image};
use host_tests::lists::{bake, print as list_text, run as list_run};
use host_tests::model::Model;
use host_tests::scene_file::Loaded;
use host_tests::{
    accuracy, bench, boards, budgets, cache_report, demo, draw, firmware_report, report, stdio,
    tell, trace, view,
};
use std::error::Error;
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
        Command::RunList(args) => list_run::run(&args),
        Command::Disassemble(args) => list_text::run(&args),
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

/// Who draws.
fn crew(args: &RenderArgs) -> draw::CrewSettings {
    draw::CrewSettings {
        renderers: args.renderers,
        slots: usize::from(args.cache),
        prefetch: args.prefetch,
        quality: args.quality.map(QualityArg::quality).unwrap_or_default(),
        depth_use: args.depth.depth_use(),
    }
}

/// What is written and told of a picture.
struct Picture {
    frame: Frame,
    figures: serde_json::Value,
    overfull: Option<draw::Overfull>,
    untextured: u32,
    /// Whether texels have fewer levels than pixels.
    is_rounded: bool,
}

impl From<draw::Drawn> for Picture {
    fn from(drawn: draw::Drawn) -> Self {
        Self {
            figures: drawn.to_json(),
            frame: drawn.frame,
            overfull: drawn.overfull,
            untextured: drawn.stats.pass_one.untextured,
            is_rounded: false,
        }
    }
}

impl Picture {
    /// A picture by draw calls, with textures or without.
    fn called(called: draw::Called, textured: bool, format: PixelFormatArg) -> Self {
        use PixelFormatArg::{Dithered565, Rgb565};
        Self {
            figures: called.to_json(),
            untextured: called.used.assembled.untextured,
            frame: called.frame,
            overfull: called.overfull,
            is_rounded: textured && !matches!(format, Rgb565 | Dithered565),
        }
    }

    /// Tells what is not as it was asked for.
    fn tell(&self, file: &std::path::Display<'_>) {
        if let Some(overfull) = &self.overfull {
            tell!("warning: {file}: {overfull}");
        }
        if self.is_rounded {
            tell!("note: texels of textures are rounded to 5, 6 and 5 bits");
        }
        if self.untextured > 0 {
            tell!(
                "note: triangles, or pieces of them, that stretch over more than 4096 texels, drawn without their texture: {}",
                self.untextured
            );
        }
    }
}

/// Draws a model with textures or dither by draw calls, where those have what is asked.
fn render_by_calls(
    args: &RenderArgs,
    model: &Model,
    textures: &TextureSet,
) -> Result<Option<Picture>, draw::DrawFailure> {
    let (view, format) = (args.view(), args.format());
    let is_dithered = format == PixelFormatArg::Dithered565;
    let is_usual = args.interp.is_none() && args.depth == DepthArg::Auto && args.prefetch == 0;
    if textures.is_empty() && !is_dithered || !is_usual {
        return Ok(None);
    }
    let skins = skins(args, textures);
    let prepared = draw::Prepared::textured(model, textures, skins.quality);
    let called = draw::draw_by_calls(
        &prepared,
        Some(skins),
        &view,
        format,
        args.renderers,
        args.cache,
    )?;
    Ok(called.map(|called| Picture::called(called, !textures.is_empty(), format)))
}

/// Textures as the flags ask for them.
fn skins<'s>(args: &RenderArgs, set: &'s TextureSet) -> draw::Skins<'s> {
    draw::Skins {
        set,
        filter: args.filter,
        quality: args.texture_quality(),
    }
}

/// Writes a picture and, where they are asked for, its figures: both files, or none.
fn write(args: &RenderArgs, drawn: &Picture) -> Result<(), Box<dyn Error>> {
    let picture = Staged::new(&args.output, &encode_image(&args.output, &drawn.frame)?)?;
    if let Some(path) = &args.stats {
        let mut text = serde_json::to_string_pretty(&drawn.figures)?;
        text.push('\n');
        Staged::new(path, text.as_bytes())?.commit()?;
    }
    Ok(picture.commit()?)
}

/// Draws a scene file to a picture.
fn render_scene(args: &RenderArgs) -> Result<(), Box<dyn Error>> {
    let loaded = Loaded::load(&args.model)?;
    let file = args.model.display();
    let (view, format) = (loaded.scene.view(), loaded.scene.pixel_format());
    let drawn = draw::SceneParts::new(&loaded).and_then(|parts| {
        let called = draw::draw_scene_file(&parts, &view, format, crew(args))?;
        Ok(Picture::called(called, parts.are_textured(), format))
    });
    let drawn = drawn.map_err(|error| format!("{file}: {error}"))?;
    write(args, &drawn)?;
    for note in loaded.notes() {
        tell!("note: {note}");
    }
    drawn.tell(&file);
    Ok(())
}

/// Draws a model to a picture.
fn render(args: &RenderArgs) -> Result<(), Box<dyn Error>> {
    if args::is_scene(&args.model) {
        return render_scene(args);
    }
    let model = Model::load(&args.model)?;
    let crew = crew(args);
    let (view, format) = (args.view(), args.format());
    let textures = match args.method() {
        // The hardware model has none.
        InterpArg::Model => TextureSet::default(),
        _ => TextureSet::load(&model, args.texture.as_deref())?.with_levels(args.levels.is_on()),
    };
    let effects = args.effects();
    let seen = effects.are_seen(&model, &view);
    let is_dithered = format == PixelFormatArg::Dithered565;
    let common = [PixelFormatArg::Rgb565, PixelFormatArg::Rgb888];
    let is_plain = args.interp.is_some() || !is_dithered && !common.contains(&format);
    if args.depth != DepthArg::Auto && seen && !is_plain {
        return Err(format!(
            "--depth {} draws no materials that shine or are transparent",
            args.depth
        )
        .into());
    }
    if args.depth.is_a_pipeline() && !textures.is_empty() {
        return Err(format!("--depth {} draws no textures", args.depth).into());
    }
    let file = args.model.display();
    let by_calls = if seen && !is_plain {
        let skins = skins(args, &textures);
        draw::draw_effects(&model, skins, (&view, format), crew, effects)
            .map(|called| Some(Picture::called(called, !textures.is_empty(), format)))
    } else {
        render_by_calls(args, &model, &textures)
    };
    let by_calls = by_calls.map_err(|error| format!("{file}: {error}"))?;
    let drawn = if let Some(picture) = by_calls {
        Ok(picture)
    } else if args.depth.is_a_pipeline() {
        draw::draw_by_depth(&model, &view, format, crew, args.depth).map(Picture::from)
    } else if textures.is_empty() {
        draw::draw_by(&model, &view, format, crew, args.method()).map(Picture::from)
    } else {
        let how = (args.filter, args.texture_quality());
        draw::draw_textured(&model, &textures, how, &view, format, crew).map(Picture::from)
    };
    let drawn = drawn.map_err(|error| format!("{file}: {error}"))?;
    write(args, &drawn)?;
    // Last, so that a refusal is one line alone.
    model.print_warnings();
    if seen && is_plain {
        tell!(
            "note: with --interp, and with formats other than rgb888 and rgb565, highlights and transparency of materials are left out"
        );
    }
    for note in textures.notes() {
        tell!("note: {note}");
    }
    drawn.tell(&file);
    Ok(())
}
