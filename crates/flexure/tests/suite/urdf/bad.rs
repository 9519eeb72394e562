//! URDFs that are no robot, or no URDF: refused with the element and its line.

use super::{ARM, DRIVES, Folder};

/// What to replace in [`ARM`], by what, where the problem is seen (text on that line), and part of the message.
type Case = (&'static str, &'static str, &'static str, &'static str);

const NUMBERS: &[Case] = &[
    ("value=\"1\"", "value=\"-1\"", "-1", "link 'upper': inertial mass value is -1 kg, must be >= 0"),
    ("value=\"1\"", "value=\"1,5\"", "1,5", "link 'upper': inertial mass value is '1,5', must be a number"),
    ("value=\"1\"", "value=\"1e400\"", "1e400", "mass value is '1e400', must be a finite number"),
    ("value=\"1\"", "value=\"NaN\"", "NaN", "mass value is 'NaN', must be a finite number"),
    ("value=\"1\"", "value=\"\"", "value=\"\"", "mass value is '', must be a number"),
    ("value=\"1\"", "value=\"${m}\"", "${m}", "mass value is '${m}', must be a number"),
    ("value=\"1\"", "value=\"0x10\"", "0x10", "must be a number"),
    ("value=\"1\"", "", "0.1 0 0", "link 'upper': inertial mass has no attribute value"),
    ("<mass value=\"1\"/>", "", "0.1 0 0", "link 'upper': inertial has no <mass>"),
    (
        "<mass value=\"1\"/>",
        "<mass value=\"1\"/><mass value=\"1\"/>",
        "0.1 0 0",
        "inertial mass stands twice",
    ),
    ("ixx=\"0.01\"", "", "0.1 0 0", "inertial inertia has no attribute ixx"),
    ("ixx=\"0.01\"", "ixx=\"-0.01\"", "-0.01", "link 'upper': inertial inertia is indefinite"),
    ("ixy=\"0\"", "ixy=\"0.1\"", "0.1\"", "link 'upper': inertial inertia is indefinite"),
    (
        "xyz=\"0 0 0.5\"",
        "xyz=\"0 0.5\"",
        "0 0.5",
        "joint 'turn': origin xyz: 3 numbers expected (x, y, z); got 2",
    ),
    ("xyz=\"0 0 0.5\"", "xyz=\"0, 0, 0.5\"", "0, 0,", "joint 'turn': origin xyz is '0,', must be a number"),
    ("xyz=\"0 0 0.5\"", "quat_xyzw=\"0 0 0 1\"", "quat", "joint 'turn': origin has a quaternion"),
    ("xyz=\"0 0 1\"", "xyz=\"0 0 0\"", "0 0 0\"/>", "joint 'turn': axis is zero, must be a direction"),
    (
        "damping=\"0.3\"",
        "damping=\"-0.3\"",
        "-0.3",
        "joint 'turn': dynamics damping is -0.3 N m s/rad, must be >= 0",
    ),
    (
        "effort=\"20\"",
        "effort=\"inf\"",
        "inf",
        "joint 'turn': limit effort is 'inf', must be a finite number",
    ),
];

const STRUCTURE: &[Case] = &[
    ("type=\"revolute\"", "type=\"floating\"", "floating", "floating bases are not modelled"),
    ("type=\"revolute\"", "type=\"planar\"", "planar", "planar joints are not modelled"),
    (
        "type=\"revolute\"",
        "type=\"revolut\"",
        "revolut\"",
        "joint 'turn' type is 'revolut': which is not known",
    ),
    ("type=\"revolute\"", "", "name=\"turn\"", "joint 'turn' has no attribute type"),
    ("name=\"turn\" ", "", "revolute", "<joint> has no attribute name"),
    ("name=\"slide\"", "name=\"turn\"", "prismatic", "joint 'turn' stands twice"),
    ("name=\"flange\"", "name=\"tool\"", "<link name=\"tool\">", "link 'tool' stands twice"),
    ("link=\"base\"/><child", "link=\"bse\"/><child", "\"bse\"", "parent link is 'bse', which is no link"),
    ("<child link=\"upper\"/>", "", "name=\"turn\"", "joint 'turn' has no <child>"),
    ("<child link=\"upper\"/>", "<child/>", "<child/>", "joint 'turn': child has no attribute link"),
    (
        "<parent link=\"base\"/>",
        "<parent link=\"tool\"/>",
        "name=\"turn\"",
        "joint 'turn' is part of a cycle",
    ),
    (
        "<link name=\"base\"/>",
        "<link name=\"base\"/><link name=\"stand\"/>",
        "stand",
        "must be one: 'base', 'stand'",
    ),
    (
        "<child link=\"tool\"/>",
        "<child link=\"upper\"/>",
        "name=\"hold\"",
        "joint 'hold': link 'upper' is the child of joint 'turn' already",
    ),
    (
        "</robot>",
        "<joint name=\"a\" type=\"fixed\"><parent link=\"tool\"/><child link=\"base\"/></joint></robot>",
        "<robot",
        "no link is the root: every link is the child of a joint",
    ),
    (
        "</robot>",
        "<link name=\"x\"/><link name=\"y\"/>\n<joint name=\"xy\" type=\"fixed\"><parent link=\"x\"/><child link=\"y\"/></joint>\
         <joint name=\"yx\" type=\"fixed\"><parent link=\"y\"/><child link=\"x\"/></joint></robot>",
        "name=\"xy\"",
        "joint 'xy' is part of a cycle",
    ),
    ("type=\"prismatic\"", "type=\"fixed\"", "", ""),
    (
        "<axis xyz=\"0 0 1\"/>",
        "<axis xyz=\"0 0 1\"/>\n<mimic joint=\"none\"/>",
        "mimic",
        "joint 'turn' mimics joint 'none': there is no such joint",
    ),
    ("<robot name=\"arm\">", "<sdf name=\"arm\">", "<sdf", "the root element is 'sdf', must be 'robot'"),
    ("</robot>", "</robot><robot/>", "</robot><robot/>", "'robot' stands after the end of <robot>"),
    ("</robot>", "", "<robot", "is never closed"),
    ("</robot>", "</link>", "</link>\n", "expected `</robot>`"),
    ("name=\"turn\"", "name=\"turn\" name=\"turn\"", "revolute", "attribute 'name' stands twice"),
    ("name=\"turn\"", "name=turn", "revolute", "value"),
    ("name=\"turn\"", "name=\"&turn;\"", "&turn;", "turn"),
    ("<link name=\"base\"/>", "<xacro:arm side=\"left\"/>", "<xacro:arm", "'xacro:arm' is a macro"),
    (
        "<robot name",
        "<!DOCTYPE robot [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;\">]>\n<robot name",
        "<!DOCTYPE",
        "a document type declaration",
    ),
];

#[test]
fn every_fault_has_its_element_and_line() {
    for &(from, to, at, fragment) in NUMBERS.iter().chain(STRUCTURE) {
        assert!(ARM.contains(from), "'{from}' is there");
        let urdf = ARM.replacen(from, to, 1);
        let found = Folder::with(&urdf).robot("", DRIVES);
        if fragment.is_empty() {
            found.unwrap_or_else(|problems| panic!("{to}: {problems}"));
            continue;
        }
        let problems = found.err().unwrap_or_else(|| panic!("accepted: {to}"));
        let problem = problems.iter().find(|problem| problem.to_string().contains(fragment));
        let problem = problem.unwrap_or_else(|| panic!("no '{fragment}' in\n{problems}"));
        assert!(problem.file().is_some_and(|file| file.ends_with("arm.urdf")), "{problem}");
        assert!(problem.hint().len() > 3, "{to}: no hint");
        let (line, _) = problem.line_column().unwrap_or_else(|| panic!("no place: {problem}"));
        let seen = urdf.lines().nth(line - 1).unwrap_or_default();
        assert!(seen.contains(at.trim_end_matches('\n')), "{to}: {problem} at line {line}: {seen}");
    }
}

/// However many warnings there are, they neither make a good file bad nor hide what is wrong with a bad one.
#[test]
fn warnings_do_not_crowd_out_errors() {
    let doubtful = |i: usize| {
        format!(
            r#"<link name="w{i}"><inertial><mass value="1"/><inertia ixx="9" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
            <joint name="f{i}" type="fixed"><parent link="tool"/><child link="w{i}"/></joint>"#
        )
    };
    let many: String = (0..1000).map(doubtful).collect();
    let good = ARM.replace("</robot>", &format!("{many}</robot>"));
    let robot = Folder::with(&good).robot("", DRIVES).unwrap_or_else(|problems| panic!("{problems}"));
    assert!(robot.warnings.len() > 10);
    let bad =
        good.replace("</robot>", "<link name=\"x\"><inertial><mass value=\"-1\"/></inertial></link></robot>");
    let problems = Folder::with(&bad).robot("", DRIVES).unwrap_err();
    assert!(problems.to_string().contains("link 'x': inertial mass value is -1 kg"), "{problems}");
}

/// Mimics that lead nowhere are refused, in a draft too: nothing else is locked in their stead.
#[test]
fn mimics_that_lead_nowhere() {
    let with = |turn: &str, slide: &str| {
        let urdf =
            ARM.replace("<axis xyz=\"0 0 1\"/>", &format!("<axis xyz=\"0 0 1\"/><mimic joint=\"{turn}\"/>"));
        urdf.replace("<dynamics damping=\"0.7\"/>", slide)
    };
    for urdf in [
        with("none", ""),
        with("turn", ""),
        with("slide", "<mimic joint=\"turn\"/>"),
        with("slide", "<mimic joint=\"none\"/>"),
    ] {
        let folder = Folder::with(&urdf);
        let problems = flexure::robot::import(
            folder.path().join("arm.urdf").to_str().unwrap(),
            &flexure::robot::ImportOptions::default(),
        )
        .unwrap_err();
        assert!(problems.to_string().contains("joint 'turn' mimics joint"), "{problems}");
    }
}

/// What is wrong with the links is not followed by what is then missing for the joints.
#[test]
fn one_fault_is_one_error() {
    let text =
        "name = 'arm'\n[links]\nkind = 'urdf'\nfile = 'elsewhere.urdf'\n[joints.turn]\nstiffness = 1\n";
    let problems = flexure::robot::robot_from_text("arm.toml", text, ".".as_ref()).unwrap_err();
    assert_eq!(problems.iter().count(), 1, "{problems}");
}

/// Names that a terminal might obey, or that are none.
#[test]
fn names_are_names() {
    for name in ["&#27;[31mred", "a&#10;b", "", " "] {
        let urdf = ARM.replace("name=\"turn\"", &format!("name=\"{name}\""));
        let problems = Folder::with(&urdf).robot("", DRIVES).unwrap_err();
        assert!(problems.to_string().contains("must be a name"), "{problems}");
        assert!(!problems.to_string().contains('\u{1b}'));
    }
}

#[test]
fn an_inertia_of_no_matter_is_a_warning() {
    let urdf = ARM.replacen("ixx=\"0.01\"", "ixx=\"0.05\"", 1);
    let robot = Folder::with(&urdf).robot("", DRIVES).unwrap();
    let [warning] = robot.warnings.as_slice() else { panic!("{:?}", robot.warnings) };
    assert!(
        warning.to_string().contains("link 'upper': inertial inertia belongs to no rigid body"),
        "{warning}"
    );
}

/// Limits in degrees are doubted; what stands for no limit, as 1e16 does in some files, is not.
#[test]
fn limits_in_degrees_are_doubted() {
    let warnings = |lower: &str, upper: &str| {
        let urdf = ARM.replace("lower=\"-2\"", &format!("lower=\"{lower}\""));
        let urdf = urdf.replace("upper=\"2.5\"", &format!("upper=\"{upper}\""));
        assert!(urdf.contains(lower) && urdf.contains(upper));
        Folder::with(&urdf).robot("", DRIVES).unwrap().warnings
    };
    let [warning] = <[_; 1]>::try_from(warnings("-180", "180")).unwrap();
    assert!(warning.to_string().contains("limit of the joint position is -180"), "{warning}");
    for (lower, upper) in [("-6.2832", "6.2832"), ("-12.57", "12.57"), ("-1e16", "1e16")] {
        assert!(warnings(lower, upper).is_empty(), "{lower} to {upper}");
    }
}

#[test]
fn bad_robot_files_about_a_urdf() {
    let cases = [
        ("locked = { slid = 0 }", DRIVES, "links.locked.slid: 'slid' is no joint of the URDF"),
        ("locked = { mount = 0 }", DRIVES, "links.locked.mount: 'mount' is a fixed joint"),
        ("locked = { slide = 'x' }", DRIVES, "links.locked.slide is text, must be a number"),
        ("locked = ['slide']", DRIVES, "links.locked is an array, must be a table"),
        ("locked = { slide = 0, turn = 0 }", DRIVES, "no joint of the robot moves"),
        ("lock = { slide = 0 }", DRIVES, "unknown key 'lock' in [links]"),
        ("", "stiffness = 1\nmotor_inertia = 1", "missing key joints.motor_damping"),
        ("", "[joints.slide]\nstiffness = 1", "missing key joints.turn.stiffness"),
        ("", "[joints.slid]\nstiffness = 1", "[joints.slid] names no moving joint"),
        ("", "[joints.mount]\nstiffness = 1", "[joints.mount] names no moving joint"),
        ("", "[joints.turn]\nstifness = 1", "unknown key 'stifness' in [joints.turn]"),
        ("", "[joints.turn]\nstiffness = [1, 2]", "joints.turn.stiffness is an array, must be a number"),
        ("", "[joints.turn]\nstiffness = -1", "joints.turn.stiffness is -1 N m/rad, must be > 0"),
        ("", "stiffness = [1, 2, 3]", "joints.stiffness: 2 numbers expected"),
        ("", "position_lower = 3", "joint 'turn': 3 and 2.5"),
    ];
    let folder = Folder::with(ARM);
    for (links, joints, fragment) in cases {
        let problems =
            folder.robot(links, joints).err().unwrap_or_else(|| panic!("accepted: {links} {joints}"));
        assert!(problems.to_string().contains(fragment), "{links} {joints}: {problems}");
        assert!(problems.iter().all(|problem| problem.line_column().is_some()), "{problems}");
    }
    let problems = flexure::robot::robot_from_text("r.toml", ARM, folder.path()).unwrap_err();
    assert!(problems.to_string().contains("this is XML"), "{problems}");
}
