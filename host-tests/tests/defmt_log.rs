//! The firmware that logs by defmt says, decoded, what the host's frames say in `Debug`'s form.

use defmt_decoder::{DecodeError, Table};
use scanbeam::scan_out::{Blocking, ErrorKind, LineWriter, Pump, Window};
use spinner::{LINES, Spinner, WIDTH};
use std::path::Path;
use std::process::{Command, Output};

/// The display of the firmware: it shows nothing, and may fail at a line.
struct Glass {
    fails_at: Option<u16>,
}

impl LineWriter for Glass {
    type Error = ErrorKind;
    type Word = u16;

    fn open(&mut self, _: Window) -> Result<(), ErrorKind> {
        Ok(())
    }

    fn write(&mut self, lines: Window, _: &[u16]) -> Result<(), ErrorKind> {
        match self.fails_at {
            Some(line) if (lines.y..lines.y + lines.height).contains(&line) => Err(ErrorKind::Bus),
            _ => Ok(()),
        }
    }
}

/// What the same frames say here.
fn expected() -> Vec<String> {
    let mut spinner = Spinner::new();
    let buffer = || -> &'static mut [u16] { vec![0; LINES * WIDTH].leak() };
    let mut pump = Pump::new(
        Blocking::over(Glass { fails_at: None }),
        [buffer(), buffer()],
    );
    let mut said = Vec::new();
    for fails_at in [None, Some(80), None] {
        pump.sink_mut().writer_mut().fails_at = fails_at;
        match spinner.frame(&mut pump) {
            Ok(stats) => {
                said.push(format!("TRACE frame: {stats:?}"));
                said.push(format!("INFO sent {} bytes", stats.scan_out.bytes_sent));
            }
            Err(error) => said.push(format!("ERROR {error:?}")),
        }
    }
    said
}

fn run(command: &mut Command) -> Output {
    let output = command.output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {text}");
    output
}

#[test]
#[ignore = "builds firmware and runs it in QEMU: a step of .ci/test"]
fn the_decoded_log_is_what_the_host_says() {
    const TARGET: &str = "thumbv7em-none-eabihf";
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/defmt-log");
    // Where all firmware is built: what both depend on is compiled once.
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("firmware");
    let built = target.join("rustup");
    run(Command::new("cargo")
        .args(["build", "--release", "--target", TARGET, "--target-dir"])
        .arg(&built)
        .current_dir(folder)
        .env_remove("RUSTFLAGS"));
    let elf = built.join(TARGET).join("release/defmt-log");
    let log = run(Command::new("timeout")
        .args(["120", "qemu-system-arm", "-machine", "mps2-an386", "-cpu"])
        .args(["cortex-m4", "-display", "none", "-monitor", "none"])
        .args(["-serial", "none", "-semihosting-config"])
        .args(["enable=on,target=native", "-kernel"])
        .arg(&elf));

    let table = Table::parse(&std::fs::read(elf).unwrap()).unwrap();
    let table = table.expect("the firmware has formats");
    let mut decoder = table.new_stream_decoder();
    decoder.received(&log.stdout);
    let mut said = Vec::new();
    loop {
        match decoder.decode() {
            Ok(frame) => {
                let level = frame.level().expect("each has a level").as_str();
                let message = frame.display_message();
                said.push(format!("{} {message}", level.to_uppercase()));
            }
            Err(DecodeError::UnexpectedEof) => break,
            Err(error) => panic!("after {said:?}: {error:?}"),
        }
    }
    let expected = expected();
    assert_eq!(said, expected);
    assert_eq!(expected.len(), 5);
    assert!(
        said[2].contains("line: 80") && said[2].contains("Bus"),
        "{}",
        said[2]
    );
}
