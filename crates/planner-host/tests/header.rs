//! The committed C header is the one that `src/abi.rs` makes.

use std::path::Path;

/// What stands above and below the generated declarations.
const ABOVE: &str = "\
/* Seatrial: the C interface of a planner in a shared library.
 *
 * Made from crates/planner-host/src/abi.rs; do not edit. Metres, seconds, radians clockwise from
 * north. A library exports one function:
 *
 *     const SeatrialPlanner *seatrial_planner_v1(void);
 *
 * and is named on the command line as `lib:./libmy_planner.so`. See docs/your-planner.md.
 */";
const BELOW: &str = "\
#ifdef __cplusplus
extern \"C\" {
#endif
/* The one function that a library exports. */
const SeatrialPlanner *seatrial_planner_v1(void);
#ifdef __cplusplus
}
#endif";

fn generated() -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config {
        language: cbindgen::Language::C,
        header: Some(ABOVE.to_owned()),
        trailer: Some(BELOW.to_owned()),
        include_guard: Some("SEATRIAL_PLANNER_H".to_owned()),
        cpp_compat: true,
        documentation_style: cbindgen::DocumentationStyle::C99,
        line_length: 100,
        usize_is_size_t: true,
        // Nothing is exported from here, so nothing is reachable by itself.
        export: cbindgen::ExportConfig {
            include: vec!["SeatrialPlanner".to_owned()],
            exclude: vec!["SeatrialEntry".to_owned()],
            ..Default::default()
        },
        ..Default::default()
    };
    let bindings = cbindgen::Builder::new()
        .with_config(config)
        .with_src(folder.join("src/abi.rs"))
        .generate()
        .expect("src/abi.rs is C");
    let mut text = Vec::new();
    bindings.write(&mut text);
    String::from_utf8(text).expect("a header is text")
}

/// With `SEATRIAL_WRITE_HEADER=1` it writes the header instead.
#[test]
fn committed_header_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("include/seatrial_planner.h");
    let text = generated();
    if std::env::var_os("SEATRIAL_WRITE_HEADER").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(committed == text, "include/seatrial_planner.h is not that of src/abi.rs");
    for name in ["SeatrialMission", "SeatrialSituation", "SeatrialCommand", "SEATRIAL_VELOCITY"] {
        assert!(text.contains(name), "{name}");
    }
}
