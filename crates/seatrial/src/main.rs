//! The command line of Seatrial with the planners of this repository.

fn main() -> std::process::ExitCode {
    seatrial::main_with(planners::registry())
}
