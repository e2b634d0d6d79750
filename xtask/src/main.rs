//! The tasks of the project: `cargo xtask` lists them.

mod adapter;
mod brushes;
mod demo;
mod failure;
mod figures;
mod gallery;
mod images;
mod mesh;
mod models;
mod programs;
mod test;

use std::process::ExitCode;

use failure::Failure;

const HELP: &str = "\
Usage: cargo xtask TASK

Tasks:
  demo              draw every model in models/ in every technique, into target/demo/
  test [-- ARGS]    run all tests, those that need a Vulkan adapter too; ARGS go to the test programs
  gallery MODEL...  draw every technique on some models, into docs/gallery/
  figures FOLDER    draw figures of the papers with models of a folder, into docs/figures/
  models            write the project's own models to models/
  mesh --triangles N -o FILE
                    write a large organic mesh of about N triangles, for benches
  brushes           write the stroke textures and other images to brushes/
  help              print this list
";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    match run(&args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("xtask: {}", failure.message);
            ExitCode::from(failure.status)
        }
    }
}

fn run(args: &[&str]) -> Result<(), Failure> {
    match args {
        [] | ["help" | "--help" | "-h"] => {
            print!("{HELP}");
            Ok(())
        }
        ["demo"] => demo::run(),
        ["test"] => test::run(&[]),
        ["test", "--", rest @ ..] => test::run(rest),
        ["gallery", models @ ..] if !models.is_empty() => gallery::run(models),
        ["gallery"] => Err(Failure::usage("use `cargo xtask gallery MODEL...`")),
        ["figures", models] => figures::run(models),
        ["figures", ..] => Err(Failure::usage("use `cargo xtask figures FOLDER`")),
        ["models"] => models::run(),
        ["brushes"] => brushes::run(),
        ["mesh", "--triangles", count, "-o", path] => mesh::run(count, path),
        ["mesh", ..] => Err(Failure::usage("use `cargo xtask mesh --triangles N -o FILE`")),
        ["test", ..] => Err(Failure::usage("arguments for the test programs go after `--`")),
        [task @ ("demo" | "models" | "brushes" | "help"), ..] => {
            Err(Failure::usage(&format!("`{task}` takes no arguments")))
        }
        [task, ..] => Err(Failure::usage(&format!(
            "there is no task `{task}`; `cargo xtask` without arguments lists the tasks"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_command_line_ends_with_status_2() {
        for args in [
            &["paint"][..],
            &["demo", "cube"],
            &["test", "weld"],
            &["help", "demo"],
            &["mesh", "9"],
        ] {
            let failure = run(args).unwrap_err();
            assert_eq!(failure.status, 2, "{args:?}: {}", failure.message);
        }
    }

    #[test]
    fn help_names_every_task() {
        for task in ["demo", "test", "gallery", "figures", "models", "mesh", "brushes", "help"] {
            assert!(HELP.contains(&format!("\n  {task} ")), "`{task}` is missing");
        }
    }
}
