//! `cargo xtask new` as a newcomer uses it, and messages as a terminal shows them.

mod support;

use std::path::Path;

use support::{folder, xtask};

#[test]
fn the_new_file_is_valid_under_its_name_and_is_never_written_over() {
    let folder = folder("new");
    let output = xtask(&folder, &["new", "my_drive"]);
    assert!(output.status.success(), "{output:?}");
    let text = std::fs::read_to_string(folder.join("my_drive.toml")).unwrap();
    let loaded = geartrain::train::load(&text).unwrap();
    assert_eq!(loaded.train.name, "my_drive");
    assert!(loaded.warnings.is_empty());
    assert!(!xtask(&folder, &["new", "my_drive"]).status.success());
    for wrong in [
        &["new"][..],
        &["new", "3rd"],
        &["new", "a-b"],
        &["new", "a", "b"],
    ] {
        assert!(!xtask(&folder, wrong).status.success(), "{wrong:?}");
    }
}

#[test]
fn a_problem_is_shown_with_its_line_and_a_caret() {
    let folder = folder("caret");
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/two_shaft.toml");
    let text = std::fs::read_to_string(example).unwrap();
    let wrong = text.replacen("position = \"100 mm\"", "position = \"3000 rpm\"", 1);
    let line = wrong
        .lines()
        .position(|line| line == "position = \"3000 rpm\"");
    let line = line.unwrap() + 1;
    std::fs::write(folder.join("wrong.toml"), wrong).unwrap();
    let output = xtask(&folder, &["inspect", "wrong.toml"]);
    let expected = format!(
        "wrong.toml:{line}: rotor \"input\", bearing \"left\": position: \"3000 rpm\" is an angular speed, \
         a length in m is wanted\n   |\n{line} | position = \"3000 rpm\"\n   |            ^^^^^^^^^^\n"
    );
    assert_eq!(String::from_utf8(output.stderr).unwrap(), expected);
}
