//! The command line of Seatrial with the planners of this repository.

#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    seatrial::main_with(planners::registry())
}
