//! What the links of a robot look like, in their bodies: for pictures.

use crate::files::base::Base;
use crate::robot::links::rigid::Pose;
use crate::robot::urdf::looks::Look;

/// Meshes of more bytes are not opened.
const LARGEST: u64 = 32 << 20;

/// Folders above that of the file in which packages are looked for.
const UPWARDS: usize = 6;

/// What the links look like, and from where files with meshes are named.
#[derive(Clone, Debug, Default)]
pub(crate) struct Looks {
    pub links: Vec<LinkLook>,
    pub base: Option<Base>,
}

/// A link that is told to look like something.
#[derive(Clone, Debug)]
pub(crate) struct LinkLook {
    /// The body that it is a part of; none for the base.
    pub body: Option<usize>,
    /// Its frame in the link frame of the body, or in the base.
    pub pose: Pose<f64>,
    pub look: Look,
}

impl Looks {
    /// The bytes of the mesh that a URDF calls `file`, if it is where such files are allowed to be: relative to the URDF, or, of a package, where
    /// the end of its path leads to from the folder of the URDF or from one above it.
    pub(crate) fn mesh(&self, file: &str) -> Option<Vec<u8>> {
        let base = self.base.as_ref()?;
        let Some(inside) = file.strip_prefix("package://") else {
            return base.bytes(file.strip_prefix("file://").unwrap_or(file), LARGEST);
        };
        // A name alone may be anybody's: at least its folder has to be the same.
        let ends = std::iter::successors(Some(inside), |rest| rest.split_once('/').map(|(_, rest)| rest));
        let ends: Vec<&str> = ends.filter(|rest| rest.contains('/')).collect();
        let places =
            (0..=UPWARDS).flat_map(|k| ends.iter().map(move |end| format!("{}{end}", "../".repeat(k))));
        places.into_iter().find_map(|place| base.bytes(&place, LARGEST))
    }
}
