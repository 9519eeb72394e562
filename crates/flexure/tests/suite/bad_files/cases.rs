//! Good files, and what makes them bad.

pub const ARM: &str = r#"name = "arm"
gravity = [0.0, 0.0, -9.81]
[links]
kind = "planar-two-link"
mass = [1.5, 0.9]
length = [0.3, 0.2]
com = [0.1, 0.05]
inertia = [0.04, 0.008]
[joints]
stiffness = [9.0, 4.0]
motor_inertia = [0.2, 0.01]
link_damping = [0.8, 0.55]
motor_damping = 0.2
torque_limit = [8.4, 1.7]
[sources]
stiffness = "assumed: by eye"
"#;

pub const TREE: &str = r#"name = "tree"
[links]
kind = "tree"
[[links.joint]]
name = "base"
kind = "revolute"
axis = [0, 0, 1]
mass = 1
com = [0.1, 0, 0]
inertia = [0.01, 0, 0, 0.01, 0, 0.01]
[[links.joint]]
name = "slide"
parent = "base"
kind = "prismatic"
xyz = [0.3, 0, 0]
mass = 2
com = [0, 0, 0]
inertia = [0.02, 0, 0, 0.03, 0, 0.04]
[[links.joint]]
name = "tool"
parent = "slide"
kind = "fixed"
mass = 0
[joints]
stiffness = 100
motor_inertia = 0.1
link_damping = 0
motor_damping = 0
"#;

pub const SCENARIO: &str = r#"robot = "quanser-2dof"
duration = 10.0
control_period = 0.001
[initial]
q_l = [0.0, 0.0]
[reference]
kind = "sine"
amplitude = [1.0, 1.0]
frequency = [1.0, 1.0]
[controller]
kind = "vcbc"
phi = "tanh"
[controller.link]
metric = [55.0, 30.0]
damping = [15.0, 10.0]
[controller.motor]
metric = [70.0, 60.0]
damping = [10.0, 5.0]
"#;

/// What is replaced, by what, the text that the problem must point at, and a part of the message.
pub type Case = (&'static str, &'static str, &'static str, &'static str);

pub const ARM_CASES: &[Case] = &[
    ("[9.0, 4.0]", "[9.0, -4.0]", "-4.0", "joints.stiffness[1] is -4 N m/rad, must be > 0"),
    ("[9.0, 4.0]", "[9.0, 0.0]", "0.0]\nmotor", "joints.stiffness[1] is 0 N m/rad, must be > 0"),
    ("[9.0, 4.0]", "[9.0, 4.0, 1.0]", "[9.0, 4.0, 1.0]", "2 numbers expected, one per joint of arm; got 3"),
    ("[9.0, 4.0]", "[]", "[]", "got 0"),
    ("[9.0, 4.0]", "[9.0, \"4\"]", "\"4\"", "joints.stiffness[1] is text, must be a number"),
    ("[9.0, 4.0]", "[9.0, nan]", "[9.0, nan]", "1 number is still to be supplied (nan)"),
    ("[9.0, 4.0]", "[-inf, 4.0]", "-inf", "must be a finite number"),
    ("[9.0, 4.0]", "[9.0, 1e999]", "1e999", "joints.stiffness[1] is inf N m/rad"),
    ("[9.0, 4.0]", "[9.0, 1e40]", "1e40", "magnitude between 1e-30 and 1e30"),
    ("[9.0, 4.0]", "[9.0, 4e-320]", "4e-320", "magnitude between 1e-30 and 1e30"),
    ("[9.0, 4.0]", "true", "true", "joints.stiffness is a boolean, must be a number"),
    ("[9.0, 4.0]", "1979-05-27", "1979", "joints.stiffness is a date"),
    ("[9.0, 4.0]", "[[9.0], 4.0]", "[9.0], 4", "joints.stiffness[0] is an array"),
    ("[9.0, 4.0]", "{ a = 9.0 }", "{ a", "joints.stiffness is a table"),
    ("[9.0, 4.0]", "[9.0, 4.0", "= [0.2", "array"),
    ("[9.0, 4.0]", "", "= \nmotor_inertia", "string"),
    ("stiffness = [9", "stifness = [9", "stifness", "unknown key 'stifness' in [joints]"),
    ("stiffness = [9.0, 4.0]\n", "", "[joints]", "missing key joints.stiffness"),
    ("[0.2, 0.01]", "[0.2, 0]", "0]\nlink", "joints.motor_inertia[1] is 0 kg m^2"),
    ("[0.8, 0.55]", "[0.8, -0.55]", "-0.55", "joints.link_damping[1] is -0.55 N m s/rad, must be >= 0"),
    ("damping = 0.2", "damping = -0.2", "-0.2", "joints.motor_damping is -0.2 N m s/rad, must be >= 0"),
    ("[8.4, 1.7]", "[8.4, 0]", "0]\n[sources]", "joints.torque_limit[1] is 0 N m, must be > 0"),
    (
        "[8.4, 1.7]",
        "[8.4, 1.7]\ntorque_rate_limit = [1, -1]",
        "-1]",
        "joints.torque_rate_limit[1] is -1 N m/s, must be > 0",
    ),
    ("[1.5, 0.9]", "[1.5, -0.9]", "-0.9", "links.mass[1] is -0.9 kg, must be > 0"),
    ("[1.5, 0.9]", "1.5", "1.5", "links.mass is a number, must be an array of 2 numbers"),
    ("[0.3, 0.2]", "[0.3]", "[0.3]", "links.length: 2 numbers expected (one per link); got 1"),
    ("[0.04, 0.008]", "[0.04, -0.008]", "-0.008", "links.inertia[1] is -0.008 kg m^2"),
    (
        "\"planar-two-link\"",
        "\"planar-2-link\"",
        "\"planar-2",
        "links.kind is 'planar-2-link', which is not known",
    ),
    ("\"planar-two-link\"", "\"urdf\"", "mass = [1.5", "unknown key 'mass' in [links]"),
    ("kind = \"planar-two-link\"\n", "", "[links]", "missing key links.kind"),
    ("\"planar-two-link\"", "\"pendulum\"", "length", "unknown key 'length' in [links]"),
    ("name = \"arm\"\n", "", "gravity", "missing key name"),
    ("name = \"arm\"", "name = \" \"", "\" \"", "name is empty"),
    ("name = \"arm\"", "name = 3", "3\n", "name is a number, must be text"),
    ("name = \"arm\"", "name = \"arm\"\nname = \"arm\"", "name = \"arm\"\ngravity", "duplicate key"),
    ("-9.81]", "-9.81, 0]", "[0.0, 0.0, -9.81, 0]", "gravity: 3 numbers expected (x, y, z); got 4"),
    (
        "[0.0, 0.0, -9.81]",
        "[0.0, -9.81, 0.0]",
        "[0.0, -9.81",
        "planar-two-link moves in the horizontal plane",
    ),
    ("[joints]", "[joint]", "joint]", "unknown key 'joint'"),
    ("[sources]", "[[sources]]", "[[sources]]", "sources is an array, must be a table"),
    ("stiffness = \"assumed", "stifness = \"assumed", "\"assumed", "'stifness' names no key of this file"),
    ("stiffness = \"assumed: by eye\"", "kind = 3", "3\n", "sources.kind is a number, must be text"),
    ("name = \"arm\"", "name = \"arm", "name", "basic string"),
    ("gravity =", "gravity", "gravity [", "key with no value"),
];

pub const TREE_CASES: &[Case] = &[
    ("axis = [0, 0, 1]", "axis = [0, 0, 0]", "[0, 0, 0]", "links.joint[0].axis is zero"),
    ("mass = 1\n", "mass = -1\n", "-1\n", "links.joint[0].mass is -1 kg, must be >= 0"),
    (
        "0.01, 0, 0, 0.01, 0,",
        "0.01, 0, 0, -0.01, 0,",
        "[0.01, 0, 0, -",
        "links.joint[0].inertia is indefinite",
    ),
    (
        "0.01, 0, 0, 0.01, 0,",
        "0.01, 0.02, 0, 0.01, 0,",
        "[0.01, 0.02",
        "links.joint[0].inertia is indefinite",
    ),
    (
        "0.01, 0, 0, 0.01, 0, 0.01",
        "0.01, 0.01, 0.01",
        "[0.01, 0.01",
        "6 numbers expected (ixx, ixy, ixz, iyy, iyz, izz)",
    ),
    (
        "parent = \"slide\"",
        "parent = \"slid\"",
        "\"slid\"",
        "links.joint[2].parent is 'slid', which is no joint above",
    ),
    (
        "parent = \"base\"",
        "parent = \"tool\"",
        "\"tool\"",
        "links.joint[1].parent is 'tool', which is no joint above",
    ),
    ("parent = \"base\"", "parent = \"slide\"", "\"slide\"\nkind", "links.joint[1].parent is 'slide'"),
    (
        "name = \"slide\"",
        "name = \"base\"",
        "[[links.joint]]\nname = \"base\"\nparent",
        "a second joint is called 'base'",
    ),
    ("kind = \"prismatic\"", "kind = \"slider\"", "\"slider\"", "links.joint[1].kind is 'slider'"),
    (
        "kind = \"fixed\"",
        "kind = \"fixed\"\naxis = [0, 0, 1]",
        "axis = [0, 0, 1]\nmass = 0",
        "unknown key 'axis'",
    ),
    ("mass = 0\n", "mass = 0.5\n", "[[links.joint]]\nname = \"tool\"", "missing key links.joint[2].com"),
    (
        "mass = 2\ncom = [0, 0, 0]\ninertia = [0.02, 0, 0, 0.03, 0, 0.04]",
        "mass = 0",
        "[[links.joint]]\nname = \"slide\"",
        "(slide) moves 0e0 kg, must be > 0",
    ),
    ("mass = 2\n", "", "[[links.joint]]\nname = \"slide\"", "missing key links.joint[1].mass"),
    ("stiffness = 100", "stiffness = [1]", "[1]", "2 numbers expected, one per joint of tree; got 1"),
];

pub const SCENARIO_CASES: &[Case] = &[
    (
        "\"quanser-2dof\"",
        "\"quanser-2dfo\"",
        "\"quanser-2dfo\"",
        "no built-in robot is called 'quanser-2dfo'",
    ),
    ("\"quanser-2dof\"", "\"none/arm.toml\"", "\"none", "cannot read"),
    ("duration = 10.0", "duration = -10.0", "-10.0", "duration is -10 s, must be > 0"),
    ("period = 0.001", "period = 20", "20\n", "control_period is 20 s, must be <= duration, 10 s"),
    ("period = 0.001", "period = 1e-12", "1e-12", "control periods in 10 s, must be <= 5e6"),
    (
        "period = 0.001",
        "period = 0.001\nintegration_tolerance = 1e-15",
        "1e-15",
        "integration_tolerance is 1e-15, must be from 1e-13 to 1e-3",
    ),
    (
        "period = 0.001",
        "period = 0.001\nintegration_tolerance = -1e-7",
        "-1e-7",
        "integration_tolerance is -1e-7, must be > 0",
    ),
    ("period = 0.001", "period = 0.001\nintegration = \"euler\"", "\"euler\"", "integration is 'euler'"),
    (
        "period = 0.001",
        "period = 0.001\nintegration = \"midpoint\"\nhold = \"continuous\"",
        "\"midpoint\"",
        "integration is \"midpoint\", but hold is \"continuous\" in line",
    ),
    ("period = 0.001", "period = 0.001\nhold = \"first-order\"", "\"first-order\"", "hold is 'first-order'"),
    (
        "[0.0, 0.0]",
        "[0.0, 0.6]",
        "[reference]",
        "the reference of joint2 starts at 0 rad and the robot at 0.6 rad",
    ),
    ("q_l = [0.0, 0.0]", "ql = [0.0, 0.6]", "ql", "unknown key 'ql' in [initial]"),
    (
        "amplitude = [1.0, 1.0]",
        "amplitude = [1.0, 1.0, 1.0]",
        "[1.0, 1.0, 1.0]",
        "2 numbers expected, one per joint of quanser-2dof; got 3",
    ),
    ("amplitude = [1.0, 1.0]\n", "", "[reference]", "missing key reference.amplitude"),
    ("\"sine\"", "\"sin\"", "\"sin\"", "reference.kind is 'sin'"),
    ("\"sine\"", "\"multisine\"", "amplitude", "unknown key 'amplitude' in [reference]"),
    ("\"sine\"", "\"samples\"\nfile = \"none.csv\"", "\"none.csv\"", "cannot read"),
    (
        "[controller]",
        "[reference.smooth_start]\nduration = 0\n[controller]",
        "0\n[controller]",
        "reference.smooth_start.duration is 0 s, must be > 0",
    ),
    (
        "[controller]",
        "[reference.smooth_start]\nduration = 1\nsettle = -1\n[controller]",
        "-1\n[controller]",
        "reference.smooth_start.settle is -1 s, must be > 0",
    ),
    (
        "[controller]",
        "[reference.time_scaling]\nspeed = 0\n[controller]",
        "0\n[controller]",
        "reference.time_scaling.speed is 0, must be > 0",
    ),
    (
        "[controller]",
        "[reference.time_scaling]\nmargin = 90\n[controller]",
        "90\n[controller]",
        "reference.time_scaling.margin is 90, must be <= 1",
    ),
    (
        "[controller]",
        "[reference.time_scaling]\nspeed = 1\nmargin = 0.9\n[controller]",
        "[reference.time_scaling]",
        "both of speed and margin are given, must be one of them",
    ),
    (
        "[controller]",
        "[reference.time_scaling]\nrise = 1\n[controller]",
        "[reference.time_scaling]",
        "neither of speed and margin are given, must be one of them",
    ),
    (
        "[controller]",
        "[reference.time_scaling]\nspeed = 1\nrise = 0\n[controller]",
        "0\n[controller]",
        "reference.time_scaling.rise is 0 s, must be > 0",
    ),
    (
        "[controller]",
        "[reference.time_scaling]\nspeed = 1\nfactor = 2\n[controller]",
        "factor",
        "unknown key 'factor' in [reference.time_scaling]",
    ),
    ("\"vcbc\"", "\"pidd\"", "\"pidd\"", "controller.kind is 'pidd'"),
    ("phi = \"tanh\"", "phi = \"tan\"", "\"tan\"", "controller.phi is 'tan'"),
    ("phi = \"tanh\"", "phi = \"coupled-tanh\"", "[controller.link]", "missing key controller.link.kappa"),
    (
        "metric = [55.0, 30.0]",
        "metric = 55.0\nkappa = 1",
        "1\ndamping",
        "controller.link.kappa is given, but phi is 'tanh'",
    ),
    (
        "metric = [55.0, 30.0]",
        "metric = [55.0, 0]",
        "0]\ndamping",
        "controller.link.metric[1] is 0 N m/rad, must be > 0",
    ),
    (
        "metric = [55.0, 30.0]",
        "metric = 55\nmetric_hardening = -1",
        "-1\n",
        "controller.link.metric_hardening is -1 N m/rad^3, must be >= 0",
    ),
    ("metric = [70.0, 60.0]", "metric = 70\nmetric_hardening = 1", "1\ndamping", "Π_m must be constant"),
    (
        "damping = [10.0, 5.0]",
        "damping = [10.0, -5.0]",
        "-5.0",
        "controller.motor.damping[1] is -5 N m s/rad, must be > 0",
    ),
    ("[controller.motor]", "[controller.motors]", "motors", "unknown key 'motors' in [controller]"),
    (
        "[controller]",
        "[[imperfection]]\nkind = \"delays\"\n[controller]",
        "\"delays\"",
        "imperfection[0].kind is 'delays', which is not known",
    ),
    (
        "[controller]",
        "[sources]\ndamping = \"assumed: x\"\n[controller]",
        "\"assumed",
        "'damping' may mean controller.link.damping or controller.motor.damping",
    ),
];
