//! URDFs made to break a reader: refused at once, in little memory, without a panic or a stack that overflows.
//!
//! The bounds here are wide, because machines that run tests are busy: 1 s of processor time and 256 MiB of address space
//! for a program built for tests. A reader that is quadratic, recurses or expands entities breaks them by orders of
//! magnitude. `tools/hostile_urdf.py target/release/flexure` measures time and memory.

use std::process::{Command, Stdio};

use crate::command::{Outcome, Place};

/// Runs `import` with limits on what it may use.
fn import(place: &Place, file: &str) -> Outcome {
    let flexure = env!("CARGO_BIN_EXE_flexure");
    let script = format!("ulimit -t 1; ulimit -v 262144; ulimit -s 1024; exec '{flexure}' import '{file}'");
    let mut shell = Command::new("sh");
    shell.args(["-c", &script]).current_dir(place.path()).env("NO_COLOR", "1").stdin(Stdio::null());
    shell.output().unwrap().into()
}

fn repeated(count: usize, entry: impl Fn(usize) -> String) -> String {
    (0..count).map(entry).collect()
}

fn joint(i: usize, more: &str) -> String {
    let next = i + 1;
    format!("<joint name='j{i}' type='revolute'><parent link='l{i}'/><child link='l{next}'/>{more}</joint>\n")
}

#[test]
fn hostile_files_are_refused_at_once() {
    let place = Place::new();
    let links = |count| repeated(count, |i| format!("<link name='l{i}'/>"));
    let entity = format!("<!DOCTYPE r [<!ENTITY a '{}'>]>", "a".repeat(10_000));
    let long = "m".repeat(60);
    let cases: &[(String, &str)] = &[
        (format!("<robot>{}", "<a>".repeat(500_000)), "element 'a' is nested 64 deep"),
        (format!("<robot>{}", "<link>".repeat(300_000)), "element 'link' is nested 64 deep"),
        ("<a>".repeat(1_000_000), "larger than 2 MiB"),
        (format!("{entity}<robot name='{}'/>", "&a;".repeat(100_000)), "document type declaration"),
        (format!("<robot name='{}'/>", "&a;".repeat(100_000)), "a"),
        (format!("<robot {}/>", repeated(150_000, |i| format!("a{i}='1' "))), "more than 64 attributes"),
        (
            format!("<robot><x {}/></robot>", repeated(150_000, |i| format!("a{i}='1' "))),
            "the robot has no link",
        ),
        (format!("<robot>{}</robot>", links(70_000)), "more than 20000 links, joints and parts of them"),
        (format!("<robot>{}</robot>", links(19_000)), "19000 links are the child of no joint"),
        (format!("<robot>{}{}</robot>", links(4001), repeated(4000, |i| joint(i, ""))), "moves 0e0 kg m^2"),
        (
            format!(
                "<robot>{}{}</robot>",
                links(3001),
                repeated(3000, |i| joint(i, &format!("<mimic joint='j{}'/>", (i + 1) % 3000)))
            ),
            "mimics joint",
        ),
        (
            format!(
                "<robot>{}{}</robot>",
                links(3000),
                repeated(3000, |i| joint(i, "").replace("'l", &format!("'{long}")))
            ),
            "which is no link of the file",
        ),
        (
            format!(
                "<robot>{}</robot>",
                repeated(4000, |i| format!(
                    "<link name='l{i}'><inertial><mass value='1,5'/></inertial></link>\n"
                ))
            ),
            "is '1,5', must be a number",
        ),
        (format!("<robot>{}</robot>", repeated(50, |i| format!("<a{i} xmlns:n{i}='u'>"))), "ill-formed"),
        (format!("<robot><!--{}", "-x".repeat(1_000_000)), "comment"),
        (format!("<robot>{}</robot>", "x&y;".repeat(500_000)), "the robot has no link"),
        ("<?xml?><?".repeat(200_000), "xml"),
        ("<".repeat(2_000_000), "not closed"),
        (format!("<robot name='{}", "<".repeat(2_000_000)), "not closed"),
        (String::new(), "there is no element <robot>"),
        ("\u{0}\u{1}\u{2}".to_owned(), "there is no element <robot>"),
    ];
    for (urdf, said) in cases {
        place.write("hostile.urdf", urdf);
        import(&place, "hostile.urdf").refused(&[said, "hostile.urdf"]);
    }
    let utf16: Vec<u8> = "<robot/>".encode_utf16().flat_map(u16::to_le_bytes).chain([0xff, 0xfe]).collect();
    place.write("hostile.urdf", utf16);
    import(&place, "hostile.urdf").refused(&["hostile.urdf is not UTF-8"]);
}
