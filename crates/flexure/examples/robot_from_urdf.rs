//! A robot from a URDF: what the URDF does not know (springs and motors) is added, then the arm answers questions about itself.

use std::error::Error;
use std::path::Path;

use flexure::robot::robot_from_text;

/// The links come from the URDF. Motors and springs are seen from the link side of the gear.
const ROBOT: &str = r#"
name = "seven-joint-arm"
gravity = [0.0, 0.0, -9.81]                     # m/s²

[links]
kind = "urdf"
file = "panda.urdf"
locked = { panda_finger_joint1 = 0.0 }          # m: the hand stays closed

[joints]
stiffness = [14e3, 14e3, 9e3, 9e3, 5e3, 5e3, 4e3]       # N m/rad
motor_inertia = [0.61, 0.61, 0.46, 0.46, 0.2, 0.2, 0.2] # kg m²
link_damping = 0.003                            # N m s/rad
motor_damping = 1.0                             # N m s/rad
"#;

/// Mass matrix, weight and inverse dynamics of a seven-joint arm agree with each other.
pub fn main() -> Result<(), Box<dyn Error>> {
    let beside = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots"));
    let arm = robot_from_text("seven-joint-arm.toml", ROBOT, beside)?.arm()?;
    let n = arm.joints();

    let q_l = [0.0, -0.5, 0.0, -2.0, 0.0, 1.5, 0.8]; // rad
    let ddq_l = [1.0, -0.5, 0.2, 0.8, -1.0, 0.3, 2.0]; // rad/s²
    let rest = vec![0.0; n];

    let mut mass = vec![0.0; n * n];
    arm.mass_matrix(&q_l, &mut mass)?;
    let (mut weight, mut torque) = (vec![0.0; n], vec![0.0; n]);
    arm.inverse_dynamics(&q_l, &rest, &rest, &mut weight)?;
    arm.inverse_dynamics(&q_l, &rest, &ddq_l, &mut torque)?;

    println!("joint  inertia [kg m²]  holds [N m]  accelerates with [N m]");
    for i in 0..n {
        println!("{:5}  {:15.4}  {:11.3}  {:22.3}", i + 1, mass[i * n + i], weight[i], torque[i]);
    }

    // At rest, M q̈ comes on top of the weight; and the mass matrix is symmetric.
    for i in 0..n {
        let inertial: f64 = (0..n).map(|j| mass[i * n + j] * ddq_l[j]).sum();
        assert!((torque[i] - weight[i] - inertial).abs() < 1e-12, "joint {}", i + 1);
        for j in 0..n {
            assert!((mass[i * n + j] - mass[j * n + i]).abs() < 1e-12);
        }
    }
    Ok(())
}
