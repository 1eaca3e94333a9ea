//! The command line with the planners of this repository, as the tests run it.
#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    seatrial::main_with(planners::registry())
}
