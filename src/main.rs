//! The command `walpha`: see `walpha --help`.

fn main() -> std::process::ExitCode {
    walpha::cli::run()
}
