//! The page of a run in motion has the numbers of the run.

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use flexure::Scenario;
use flexure::files::Outside;
use flexure::report::{Viewed, view};
use flexure::reproduce::Experiment;
use flexure::scenario::{load_scenario, load_scenario_with};
use flexure::simulate::Trace;
use serde_json::Value;

/// A scenario of half a second, run, with its trace.
fn run(name: &str, change: impl Fn(&mut Scenario)) -> (Experiment, Trace) {
    let mut scenario = load_scenario(name).expect("built in");
    scenario.duration = 0.5;
    change(&mut scenario);
    let signals = scenario.signals().expect("a good loop");
    let mut trace = Trace::from(&*signals);
    let experiment =
        Experiment::new(scenario, &mut [&mut trace], &flexure::progress::unwatched).expect("a run");
    (experiment, trace)
}

/// The page, of robots that look as their files say, or of built-in ones.
fn page(runs: &[Viewed<'_>]) -> String {
    let (page, warnings) = view(runs).expect("a page");
    assert!(warnings.is_empty(), "{warnings:?}");
    page
}

/// What the page is given.
fn document(page: &str) -> Value {
    let (_, rest) =
        page.split_once(r#"<script type="application/json" id="flexure-runs">"#).expect("its place");
    let (text, _) = rest.split_once("</script>").expect("an end");
    serde_json::from_str(text).expect("JSON")
}

fn column(text: &Value) -> Vec<f32> {
    let bytes = BASE64_STANDARD.decode(text.as_str().expect("text")).expect("base 64");
    bytes.chunks_exact(4).map(|bytes| f32::from_le_bytes(bytes.try_into().expect("four"))).collect()
}

#[expect(clippy::cast_possible_truncation, reason = "as the page has them")]
fn single(values: &[f64]) -> Vec<f32> {
    values.iter().map(|&x| x as f32).collect()
}

#[test]
fn columns_are_those_of_the_trace_and_springs_those_of_the_robot() {
    let (experiment, trace) = run("panda-tanh-smooth", |_| {});
    let document = document(&page(&[experiment.viewed(Some(true), "well")]));
    let run = &document["runs"][0];
    assert_eq!((&run["name"], &run["law"]), (&"panda-tanh-smooth".into(), &"v-CBC with φ = tanh".into()));
    assert_eq!(run["samples"], 501);
    let columns = &run["columns"];
    assert_eq!(column(&columns["t"]), single(trace.column("t").expect("times")));
    for prefix in ["q_l", "q_m", "q_ld", "e_l", "u_m"] {
        for (joint, values) in trace.joints(prefix).iter().enumerate() {
            assert_eq!(column(&columns[prefix][joint]), single(values), "{prefix} of joint {joint}");
        }
    }
    let (q_l, q_m) = (trace.joints("q_l"), trace.joints("q_m"));
    for (joint, stiffness) in experiment.scenario.robot.stiffness.iter().enumerate() {
        let spring = column(&columns["spring"][joint]);
        for (k, torque) in spring.iter().enumerate() {
            // K ζ to the digits of a single.
            let expected = stiffness * (q_m[joint][k] - q_l[joint][k]);
            assert!((f64::from(*torque) - expected).abs() <= 1e-6 * expected.abs() + 1e-12, "{joint} {k}");
        }
    }
    assert!(columns["external"].is_null());
    assert_eq!(run["robot"]["bodies"].as_array().map(Vec::len), Some(7));
}

#[test]
fn pushes_and_stops_are_told_when_they_happen() {
    let (experiment, trace) = run("two-link-everything", |scenario| scenario.duration = 8.0);
    let document = document(&page(&[experiment.viewed(Some(true), "well")]));
    let run = &document["runs"][0];
    let push = &run["pushes"][0];
    let [from, to] = ["from", "to"].map(|key| push[key].as_f64().expect("a time"));
    let (t, external) = (column(&run["columns"]["t"]), column(&run["columns"]["external"][0]));
    for (t, torque) in t.iter().zip(&external) {
        let inside = (from..to).contains(&f64::from(*t));
        assert!(inside || *torque == 0.0, "{torque} N m at {t} s, pushed from {from} to {to} s");
    }
    assert!(external.iter().any(|torque| *torque != 0.0));
    let stopped = trace.column("stopped").expect("it has a guard");
    let stops =
        run["events"].as_array().expect("a list").iter().filter(|event| event["kind"] == "stop").count();
    let begun = stopped.windows(2).filter(|pair| pair[0] < 0.5 && pair[1] > 0.5).count();
    assert_eq!(stops, begun);
}

#[test]
fn what_diverges_ends_in_an_event() {
    let (experiment, _) = run("two-link-tanh", |scenario| scenario.control_period = 0.01);
    let document = document(&page(&[experiment.viewed(Some(false), "lost")]));
    let events = document["runs"][0]["events"].as_array().expect("a list");
    assert!(events.iter().any(|event| event["kind"] == "diverged"), "{events:?}");
    assert_eq!(document["runs"][0]["verdict"]["good"], false);
}

#[test]
fn no_name_ends_the_place_that_it_stands_in() {
    let evil = "</script><script>alert(1)</script><!--";
    let (experiment, _) = run("pendulum-tanh", |scenario| evil.clone_into(&mut scenario.name));
    let page = page(&[experiment.viewed(Some(true), evil)]);
    assert_eq!(document(&page)["runs"][0]["name"], evil);
    assert!(!page.contains("alert(1)</script>"));
    let (_, rest) = page.split_once("flexure-runs\">").expect("its place");
    assert!(!rest.split_once("</script>").expect("an end").0.contains('<'));
}

#[test]
fn two_runs_stand_beside_each_other() {
    let (one, _) = run("pendulum-tanh", |_| {});
    let (other, _) = run("two-link-tanh-smooth", |_| {});
    let document = document(&page(&[one.viewed(Some(true), "a"), other.viewed(Some(false), "b")]));
    let names: Vec<&Value> =
        document["runs"].as_array().expect("a list").iter().map(|run| &run["name"]).collect();
    assert_eq!(names, ["pendulum-tanh", "two-link-tanh-smooth"]);
}

const ROBOT: &str = r#"
name = "arm"
links = { kind = "urdf", file = "arm.urdf" }
[joints]
stiffness = [50.0]
motor_inertia = [0.01]
link_damping = [0.0]
motor_damping = [0.1]
"#;

const ARM: &str = r#"<robot name="arm">
  <link name="base"><visual><geometry><box size="0.2 0.2 0.1"/></geometry></visual></link>
  <joint name="hip" type="continuous"><parent link="base"/><child link="thigh"/><axis xyz="0 1 0"/></joint>
  <link name="thigh">
    <visual><geometry><mesh filename="package://arm_description/meshes/thigh.dae"/></geometry></visual>
    <collision><origin xyz="0 0 -0.1"/><geometry><mesh filename="package://arm_description/meshes/thigh.stl" scale="0.001 0.001 0.001"/></geometry></collision>
    <inertial><origin xyz="0 0 -0.1"/><mass value="1"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
  </link>
  <joint name="hold" type="fixed"><parent link="thigh"/><child link="lamp"/><origin xyz="0 0 -0.3" rpy="0 0 0.5"/></joint>
  <link name="lamp"><visual><origin xyz="0.1 0 0"/><geometry><sphere radius="0.03"/></geometry></visual></link>
</robot>"#;

const LOOP: &str = r#"
robot = "arm.toml"
duration = 0.05
control_period = 0.001
initial = "at rest"
reference = { kind = "sine", amplitude = [0.1], frequency = [1.0] }
controller = { kind = "vcbc", phi = "tanh" }
"#;

/// A triangle in an STL file of bytes.
fn stl() -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend(1u32.to_le_bytes());
    let numbers: [f32; 12] = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 100.0, 0.0, 0.0, 0.0, 50.0, 25.0];
    bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    bytes.extend([0; 2]);
    bytes
}

/// What `of` makes of the loop of a URDF that lies in the folder `urdf` of a package whose meshes are there.
fn package<T>(outside: Outside, of: impl Fn(Scenario) -> T) -> T {
    let package = tempfile::tempdir().expect("a folder");
    let home = package.path().join("arm_description");
    std::fs::create_dir_all(home.join("urdf")).expect("a folder");
    std::fs::create_dir_all(home.join("meshes")).expect("a folder");
    for (name, text) in [("arm.urdf", ARM), ("arm.toml", ROBOT), ("loop.toml", LOOP)] {
        std::fs::write(home.join("urdf").join(name), text).expect("a file");
    }
    std::fs::write(home.join("meshes/thigh.stl"), stl()).expect("a file");
    let path = home.join("urdf/loop.toml");
    of(load_scenario_with(path.to_str().expect("UTF-8"), outside).unwrap_or_else(|p| panic!("{p}")))
}

/// The robot of the page, and warnings.
fn arm(outside: Outside) -> (Value, Vec<String>) {
    package(outside, |scenario| {
        let experiment = Experiment::new(scenario, &mut [], &flexure::progress::unwatched).expect("a run");
        let (page, warnings) = view(&[experiment.viewed(Some(true), "well")]).expect("a page");
        let warnings = warnings.iter().map(ToString::to_string).collect();
        (document(&page)["runs"][0]["robot"].clone(), warnings)
    })
}

#[test]
fn links_look_as_their_urdf_says() {
    let (robot, warnings) = arm(Outside::Allowed);
    assert!(warnings.is_empty(), "{warnings:?}");
    assert_eq!(
        (&robot["base_shapes"][0]["kind"], &robot["base_shapes"][0]["size"][2]),
        (&"box".into(), &0.1.into())
    );
    let shapes = &robot["bodies"][0]["shapes"];
    assert_eq!(shapes.as_array().map(Vec::len), Some(2), "{shapes}");
    // No program reads the visual: what collides stands in, in metres.
    assert_eq!(shapes[0]["kind"], "mesh");
    assert_eq!(shapes[0]["translation"], serde_json::json!([0.0, 0.0, -0.1]));
    let corners = column(&shapes[0]["triangles"]);
    assert_eq!(corners, single(&[0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.05, 0.025]));
    // What is fixed to a body is shown in it: (0, 0, −0.3) and 0.1 along x, turned by half a radian.
    assert_eq!(shapes[1]["kind"], "sphere");
    let at: Vec<f64> = (0..3).map(|k| shapes[1]["translation"][k].as_f64().expect("a number")).collect();
    let expected = [0.1 * 0.5f64.cos(), 0.1 * 0.5f64.sin(), -0.3];
    assert!(at.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{at:?}");
    // The body ends where its shapes do, on the way to their middle.
    let tip: Vec<f64> = (0..3).map(|k| robot["bodies"][0]["tip"][k].as_f64().expect("a number")).collect();
    assert!(tip[2] < -0.2 && tip[2] > -0.35, "{tip:?}");
}

/// The mesh is outside of the folder of the file that names it: it is not opened, and no part of the robot is shown without the rest.
#[test]
fn meshes_outside_are_not_opened() {
    let (robot, warnings) = arm(Outside::Refused);
    let told = warnings.join("\n");
    assert!(told.contains("arm_description/meshes/thigh.dae") && told.contains("joint to joint"), "{told}");
    assert_eq!(robot["base_shapes"], serde_json::json!([]));
    assert_eq!(robot["bodies"][0]["shapes"], serde_json::json!([]));
}

#[test]
fn what_is_not_known_of_a_run_is_not_said() {
    let (experiment, _) = run("pendulum-tanh", |_| {});
    assert!(
        document(&page(&[experiment.viewed(None, "broken off")]))["runs"][0]["verdict"]["good"].is_null()
    );
}

/// Limits are those that act: a guard's are tighter than the drives', and `unlimited` takes all away.
#[test]
fn limits_are_those_that_act() {
    let torque = |unlimited| {
        let (experiment, _) = run("planar-2r-tanh", |scenario| scenario.plant.unlimited = unlimited);
        document(&page(&[experiment.viewed(Some(true), "well")]))["runs"][0]["robot"]["limits"]["torque"]
            .clone()
    };
    assert!(torque(false)[0].is_number());
    assert!(torque(true)[0].is_null());
}
