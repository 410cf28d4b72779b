//! The command line tool: see `scanbeam --help`.

use host_tests::args::{self, Command, EXIT_BAD_INPUT, RenderArgs, Stop};
use host_tests::image_out::{write_atomically, write_image};
use host_tests::model::Model;
use host_tests::{cache_report, demo, draw, firmware_report};
use std::error::Error;
use std::process::ExitCode;

fn main() -> ExitCode {
    let command = match args::parse(std::env::args_os()) {
        Ok(command) => command,
        Err(Stop::Text(text)) => {
            print!("{text}");
            return ExitCode::SUCCESS;
        }
        Err(Stop::Refused(line)) => {
            eprintln!("{line}");
            return ExitCode::from(EXIT_BAD_INPUT);
        }
    };
    let done = match command {
        Command::Render(args) => render(&args),
        Command::Demo(args) => demo::run(&args),
        Command::Cache(args) => cache_report::run(&args),
        Command::Firmware(args) => match firmware_report::run(&args) {
            // The frames were compared and differ: bad firmware, not bad input.
            Ok(false) => return ExitCode::FAILURE,
            Ok(true) => Ok(()),
            Err(error) => Err(error),
        },
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(EXIT_BAD_INPUT)
        }
    }
}

/// Draws a model to a picture.
fn render(args: &RenderArgs) -> Result<(), Box<dyn Error>> {
    let model = Model::load(&args.model)?;
    let crew = draw::CrewSettings {
        renderers: args.renderers,
        slots: usize::from(args.cache),
        prefetch: args.prefetch,
    };
    let drawn = draw::draw(&model, &args.view(), args.format, crew)?;
    write_image(&args.output, &drawn.frame)?;
    if let Some(path) = &args.stats {
        let mut text = serde_json::to_string_pretty(&drawn.to_json())?;
        text.push('\n');
        write_atomically(path, text.as_bytes())?;
    }
    Ok(())
}
