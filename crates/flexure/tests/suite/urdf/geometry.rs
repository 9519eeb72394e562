//! Where joints and masses end up.

use flexure::robot::load_robot;
use flexure::robot::{Body, JointKind};

use super::{ARM, bodies};

fn close(found: &[f64], exact: &[f64], tolerance: f64) {
    for (a, b) in found.iter().zip(exact) {
        assert!((a - b).abs() <= tolerance, "{found:?} against {exact:?}");
    }
}

/// The tool hangs on the slider through two fixed joints: 0.2 up, then pitched by 90° so that its z points along x. Its
/// centre is at (0.1, 0, 0.2); its principal axes (0.001, 0.002, 0.003) go by the yaw of the inertial frame to
/// (0.002, 0.001, 0.003) and by the pitch to (0.003, 0.001, 0.002).
#[test]
fn fixed_joints_are_merged_with_their_orientations() {
    let bodies = bodies(ARM, "");
    let [turn, slide] = bodies.as_slice() else { panic!("{bodies:?}") };
    assert_eq!((turn.kind, turn.parent, turn.axis), (JointKind::Revolute, None, [0.0, 0.0, 1.0]));
    assert_eq!((slide.kind, slide.parent, slide.axis), (JointKind::Prismatic, Some(0), [1.0, 0.0, 0.0]));
    close(&turn.translation, &[0.0, 0.0, 0.5], 0.0);
    close(&slide.translation, &[0.3, 0.0, 0.0], 0.0);
    assert_eq!((turn.mass, slide.mass), (1.0, 1.5));
    // Centre of 1 kg at the origin and 0.5 kg at (0.1, 0, 0.2).
    let centre = [0.1 / 3.0, 0.0, 0.2 / 3.0];
    close(&slide.com, &centre, 1e-16);
    let reduced = 1.0 * 0.5 / 1.5; // two point masses about their common centre: reduced mass × distance²
    close(
        &[slide.inertia[0][0], slide.inertia[1][1], slide.inertia[2][2], slide.inertia[0][2]],
        &[
            0.01 + 0.003 + reduced * 0.04,
            0.01 + 0.001 + reduced * 0.05,
            0.01 + 0.002 + reduced * 0.01,
            -reduced * 0.1 * 0.2,
        ],
        1e-16,
    );
}

/// A joint held still is a fixed joint at that place: the slider 0.2 m out adds to the upper link.
#[test]
fn locked_joints_are_fixed_where_they_are_held() {
    let locked = bodies(ARM, "locked = { slide = 0.2 }");
    let [turn] = locked.as_slice() else { panic!("{locked:?}") };
    close(&[turn.mass], &[2.5], 0.0);
    let x = (0.1 + 1.0 * 0.5 + 0.5 * (0.5 + 0.1)) / 2.5;
    close(&turn.com, &[x, 0.0, 0.5 * 0.2 / 2.5], 1e-15);

    // Held at a quarter turn, the upper link points along y of the base: what was x for the slider is y.
    let locked = bodies(ARM, "locked = { turn = 1.5707963267948966 }");
    let [slide] = locked.as_slice() else { panic!("{locked:?}") };
    assert_eq!(slide.parent, None);
    close(&slide.translation, &[0.0, 0.3, 0.5], 1e-15);
    let axis: Vec<f64> = slide.rotation.iter().map(|row| row[0]).collect();
    close(&axis, &[0.0, 1.0, 0.0], 1e-15);
}

/// Without `<axis>` a joint moves about x; a long axis is a direction.
#[test]
fn axes_default_to_x_and_are_made_unit() {
    let robot = ARM.replace(r#"<axis xyz="0 0 1"/>"#, "");
    close(&bodies(&robot, "")[0].axis, &[1.0, 0.0, 0.0], 0.0);
    let robot = ARM.replace(r#"<axis xyz="0 0 1"/>"#, r#"<axis xyz="0 3 4"/>"#);
    close(&bodies(&robot, "")[0].axis, &[0.0, 0.6, 0.8], 1e-16);
}

/// Joints come depth first in the order of the file, whatever the order of links and joints in it.
#[test]
fn branches_come_depth_first() {
    let link = |name: &str| {
        format!(
            r#"<link name="{name}"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>"#
        )
    };
    let joint = |name: &str, parent: &str, child: &str| {
        format!(
            r#"<joint name="{name}" type="continuous"><parent link="{parent}"/><child link="{child}"/></joint>"#
        )
    };
    let links: String = ["a", "b", "c", "d", "e", "root"].into_iter().map(link).collect();
    // d hangs on b, b and c on a, a and e on the root.
    let joints = joint("j4", "b", "d")
        + &joint("j2", "a", "b")
        + &joint("j3", "a", "c")
        + &joint("j1", "root", "a")
        + &joint("j5", "root", "e");
    let robot =
        super::Folder::with(&format!("<robot>{joints}{links}</robot>")).robot("", super::DRIVES).unwrap();
    let names: Vec<_> = robot.joints.iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(names, ["j1", "j2", "j4", "j3", "j5"]);
    let flexure::robot::Links::Tree(bodies) = robot.links else { panic!() };
    let parents: Vec<_> = bodies.iter().map(|body| body.parent).collect();
    assert_eq!(parents, [None, Some(0), Some(1), Some(0), None]);
}

/// Files as they are found: namespaces, prefixes, plug-ins, meshes that are not there, comments, `&quot;`.
#[test]
fn files_of_any_age_are_read() {
    let plain = bodies(ARM, "");
    let old = ARM
        .replace(
            "<robot name=\"arm\">",
            "<!-- made by xacro -->\n<robot name=\"arm\" xmlns=\"http://a\" xmlns:xacro=\"http://ros.org/wiki/xacro\" \
             xmlns:sensor='http://b'>\n<gazebo reference=\"upper\"><sensor:camera name=\"c\"><joint name='x'/>\
             </sensor:camera></gazebo><transmission name=\"t\"><joint name=\"turn\"/></transmission>\
             <material name=\"&quot;grey&quot; &amp; co\"/><joint_properties damping=\"0\"/>",
        )
        .replace("<?xml version=\"1.0\"?>", "\u{feff}<?xml version=\"1.0\" encoding=\"utf-8\"?>")
        .replace('\n', "\r\n")
        .replace("value=\"1\"", "value = ' +1.0e0 '")
        .replace("xyz=\"0.3 0 0\"", "xyz=\"\t0.3  0\n0. \"");
    assert_eq!(bodies(&old, ""), plain);
    let crowded = ARM.replace("<link name=\"base\"/>", "<link name=\"base\"><inertial/></link>");
    assert!(super::Folder::with(&crowded).robot("", super::DRIVES).is_err());
    let dust = ARM.replace("ixy=\"0\"", "ixy=\"2.4e-35\"");
    assert_eq!(bodies(&dust, ""), plain);
}

/// The arm of the URDF is the arm of the file that spells its tree out: an independent path through the readers.
#[test]
fn a_urdf_and_the_same_tree_are_the_same_robot() {
    let tree = r#"
name = "arm"
[links]
kind = "tree"
[[links.joint]]
name = "turn"
kind = "revolute"
axis = [0, 0, 1]
xyz = [0, 0, 0.5]
mass = 1
com = [0.1, 0, 0]
inertia = [0.01, 0, 0, 0.02, 0, 0.02]
[[links.joint]]
name = "slide"
parent = "turn"
kind = "prismatic"
axis = [1, 0, 0]
xyz = [0.3, 0, 0]
mass = 1
com = [0, 0, 0]
inertia = [0.01, 0, 0, 0.01, 0, 0.01]
[[links.joint]]
name = "hold"
parent = "slide"
kind = "fixed"
xyz = [0, 0, 0.2]
rpy = [0, 1.5707963267948966, 0]
mass = 0.5
com = [0, 0, 0.1]
inertia = [0.001, 0, 0, 0.002, 0, 0.003]
inertia_rpy = [0, 0, 1.5707963267948966]
[joints]
stiffness = 1
motor_inertia = 1
link_damping = 1
motor_damping = 1
"#;
    let robot = flexure::robot::robot_from_text("tree.toml", tree, ".".as_ref()).unwrap();
    let flexure::robot::Links::Tree(spelt_out) = robot.links else { panic!() };
    for (a, b) in spelt_out.iter().zip(&bodies(ARM, "")) {
        let all = |body: &Body| {
            let mut numbers = vec![body.mass];
            numbers.extend(body.com.iter().chain(&body.axis).chain(&body.translation));
            numbers.extend(body.inertia.iter().chain(&body.rotation).flatten());
            numbers
        };
        close(&all(a), &all(b), 1e-16);
    }
}

#[test]
fn the_panda_is_read_from_its_urdf() {
    let robot = load_robot("panda").unwrap();
    assert_eq!(robot.joints[6].name, "panda_joint7");
    assert_eq!(robot.limits.torque, [87.0, 87.0, 87.0, 87.0, 12.0, 12.0, 12.0]);
    assert_eq!(robot.limits.velocity, [2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61]);
    assert_eq!((robot.limits.lower[3], robot.limits.upper[3]), (-3.0718, -0.0698));
}
