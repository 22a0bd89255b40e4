//! The command `walpha`: see `walpha --help`.

fn main() -> std::process::ExitCode {
    walpha::cli::run(std::env::args_os().collect()).into()
}
