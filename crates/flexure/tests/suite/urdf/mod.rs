//! Robots from URDF files: what is read, and what is refused.

mod bad;
mod drives;
mod geometry;
mod import;
mod typical;

use std::path::Path;

use flexure::files::Problems;
use flexure::robot::{Body, Links, Robot, robot_from_text};

/// A folder with `arm.urdf` in it.
struct Folder(tempfile::TempDir);

impl Folder {
    fn with(urdf: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("arm.urdf"), urdf).unwrap();
        Self(folder)
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    /// The robot of `[links]` with more of its lines and of `[joints]`.
    fn robot(&self, links: &str, joints: &str) -> Result<Robot, Problems> {
        let text =
            format!("name = 'arm'\n[links]\nkind = 'urdf'\nfile = 'arm.urdf'\n{links}\n[joints]\n{joints}\n");
        robot_from_text("arm.toml", &text, self.path())
    }
}

/// Numbers for whatever joints there are.
const DRIVES: &str = "stiffness = 100\nmotor_inertia = 0.1\nlink_damping = 0.1\nmotor_damping = 0.2";

fn bodies(urdf: &str, links: &str) -> Vec<Body> {
    let robot = Folder::with(urdf).robot(links, DRIVES).unwrap_or_else(|problems| panic!("{problems}"));
    match robot.links {
        Links::Tree(bodies) => bodies,
        other => panic!("{other:?}"),
    }
}

/// Two links of 1 kg on joints about z and along x, a massless flange, and a tool of 0.5 kg 0.1 m out on it.
const ARM: &str = r#"<?xml version="1.0"?>
<robot name="arm">
  <link name="base"/>
  <link name="upper">
    <inertial><origin xyz="0.1 0 0"/><mass value="1"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/></inertial>
  </link>
  <link name="slider">
    <inertial><mass value="1"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
    <visual><geometry><mesh filename="package://nowhere/slider.stl"/></geometry></visual>
  </link>
  <link name="flange"/>
  <link name="tool">
    <inertial><origin xyz="0 0 0.1" rpy="0 0 1.5707963267948966"/><mass value="0.5"/><inertia ixx="0.001" ixy="0" ixz="0" iyy="0.002" iyz="0" izz="0.003"/></inertial>
  </link>
  <joint name="turn" type="revolute">
    <parent link="base"/><child link="upper"/><origin xyz="0 0 0.5"/><axis xyz="0 0 1"/>
    <limit effort="20" velocity="3" lower="-2" upper="2.5"/><dynamics damping="0.3" friction="0.05"/>
  </joint>
  <joint name="slide" type="prismatic">
    <parent link="upper"/><child link="slider"/><origin xyz="0.3 0 0"/>
    <limit effort="50" velocity="1" lower="-0.1" upper="0.4"/><dynamics damping="0.7"/>
  </joint>
  <joint name="mount" type="fixed"><parent link="slider"/><child link="flange"/><origin xyz="0 0 0.2"/></joint>
  <joint name="hold" type="fixed"><parent link="flange"/><child link="tool"/><origin rpy="0 1.5707963267948966 0"/></joint>
</robot>
"#;
