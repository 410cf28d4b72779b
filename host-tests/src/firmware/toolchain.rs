//! The compilers that can build for the boards: rustup's, or Debian's with `core` from source.

use super::{BOARDS, Board, FirmwareError, TOOLCHAIN_VARIABLE};
use std::path::Path;
use std::process::Command;
use std::{env, fs};

/// Where the compiler for the boards comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The `rustc` of the path, with `core` installed for all targets.
    Rustup,
    /// Debian's, with `core` built from `rust-web-src` and linked by `ld.lld`.
    Debian,
}

impl Source {
    /// The name in [`TOOLCHAIN_VARIABLE`] and of the target directory.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rustup => "rustup",
            Self::Debian => "debian",
        }
    }
}

/// A compiler that builds for all [`BOARDS`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Toolchain {
    /// Where it comes from.
    pub source: Source,
    /// What `rustc --version` says; instruction counts differ from version to version.
    pub version: String,
}

const DEBIAN_RUSTC: &str = "/usr/bin/rustc";
const DEBIAN_CARGO: &str = "/usr/bin/cargo";
const DEBIAN_LINKER: &str = "ld.lld";
/// The oldest compiler that our packages build with; Debian 12's own `rustc` is 1.63.
const OLDEST_MINOR: u32 = 87;

impl Toolchain {
    /// The toolchain that [`TOOLCHAIN_VARIABLE`] names, or the first complete one.
    ///
    /// # Errors
    ///
    /// [`FirmwareError::NoToolchain`] with the commands that install one, or
    /// [`FirmwareError::UnknownToolchain`].
    pub fn find() -> Result<Self, FirmwareError> {
        Self::complete(true).map(|mut found| found.swap_remove(0))
    }

    /// The toolchain that [`TOOLCHAIN_VARIABLE`] names, or every complete one: at least one.
    ///
    /// # Errors
    ///
    /// As [`find`](Self::find).
    pub fn all() -> Result<Vec<Self>, FirmwareError> {
        Self::complete(false)
    }

    fn complete(first: bool) -> Result<Vec<Self>, FirmwareError> {
        let value = env::var(TOOLCHAIN_VARIABLE).unwrap_or_default();
        let sources: &[Source] = match value.as_str() {
            "" => &[Source::Rustup, Source::Debian],
            "rustup" => &[Source::Rustup],
            "debian" => &[Source::Debian],
            _ => return Err(FirmwareError::UnknownToolchain { value }),
        };
        let (mut found, mut reasons) = (Vec::new(), Vec::new());
        for &source in sources {
            let version = match source {
                Source::Rustup => rustup_version(),
                Source::Debian => debian_version(),
            };
            match version {
                Ok(version) => found.push(Self { source, version }),
                Err(reason) => reasons.push(format!("{}: {reason}", source.name())),
            }
            if first && !found.is_empty() {
                break;
            }
        }
        if found.is_empty() {
            return Err(FirmwareError::NoToolchain {
                reasons: reasons.join("; "),
            });
        }
        Ok(found)
    }

    /// `cargo`, set up to compile for these boards, without a subcommand yet.
    pub(super) fn cargo(&self, boards: &[Board]) -> Command {
        match self.source {
            Source::Rustup => clean_command("cargo"),
            Source::Debian => {
                let mut cargo = clean_command(DEBIAN_CARGO);
                cargo.env("RUSTC", DEBIAN_RUSTC).env("RUSTC_BOOTSTRAP", "1");
                for board in boards {
                    let target = board.target.replace('-', "_").to_uppercase();
                    cargo.env(format!("CARGO_TARGET_{target}_LINKER"), DEBIAN_LINKER);
                }
                cargo
            }
        }
    }
}

/// The version of the path's compiler, or why it cannot build for the boards.
fn rustup_version() -> Result<String, String> {
    for board in BOARDS {
        let args = ["--print", "target-libdir", "--target", board.target];
        let directory = first_line("rustc", &args)?;
        let has_core = fs::read_dir(&directory).is_ok_and(|mut entries| {
            entries.any(|entry| {
                entry.is_ok_and(|entry| entry.file_name().to_string_lossy().starts_with("libcore-"))
            })
        });
        if !has_core {
            return Err(format!("no `core` for {}", board.target));
        }
    }
    first_line("rustc", &["--version"])
}

/// The version of Debian's compiler, or which of its packages is missing.
fn debian_version() -> Result<String, String> {
    let version = first_line(DEBIAN_RUSTC, &["--version"])?;
    let minor = version
        .strip_prefix("rustc 1.")
        .and_then(|rest| rest.split('.').next()?.parse::<u32>().ok());
    if minor.is_none_or(|minor| minor < OLDEST_MINOR) {
        return Err(format!(
            "{DEBIAN_RUSTC} is {version}, 1.{OLDEST_MINOR} is the oldest that will do (rustc-web)"
        ));
    }
    first_line(DEBIAN_CARGO, &["--version"])?;
    first_line(DEBIAN_LINKER, &["--version"])?;
    let sysroot = first_line(DEBIAN_RUSTC, &["--print", "sysroot"])?;
    let core = Path::new(&sysroot).join("lib/rustlib/src/rust/library/core/src/lib.rs");
    if !core.is_file() {
        return Err(format!("no {} (rust-web-src)", core.display()));
    }
    Ok(version)
}

/// The first line that a program prints, or why there is none.
fn first_line(program: &str, args: &[&str]) -> Result<String, String> {
    let output = clean_command(program)
        .args(args)
        .output()
        .map_err(|error| format!("{program}: {error}"))?;
    if !output.status.success() {
        return Err(format!("{program} {} failed", args.join(" ")));
    }
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines()
        .next()
        .map(str::to_owned)
        .ok_or_else(|| format!("{program} {} says nothing", args.join(" ")))
}

/// A command without the variables that would change what the inner cargo builds.
pub(crate) fn clean_command(program: &str) -> Command {
    let mut command = Command::new(program);
    for (name, _) in env::vars_os() {
        if is_of_outer_build(&name.to_string_lossy()) {
            command.env_remove(&name);
        }
    }
    command
}

/// Whether a variable belongs to the build that this process is part of. Where packages come from,
/// and which toolchain rustup's proxies start, stays.
pub fn is_of_outer_build(name: &str) -> bool {
    const KEPT: [&str; 5] = [
        "CARGO_HOME",
        "CARGO_HTTP_",
        "CARGO_NET_",
        "CARGO_REGISTRIES_",
        "CARGO_REGISTRY_",
    ];
    const REMOVED: [&str; 6] = [
        "CARGO",
        "RUSTC",
        "RUSTDOC",
        "RUSTFLAGS",
        "LD_LIBRARY_PATH",
        "DYLD_",
    ];
    REMOVED.iter().any(|prefix| name.starts_with(prefix))
        && !KEPT.iter().any(|prefix| name.starts_with(prefix))
}
