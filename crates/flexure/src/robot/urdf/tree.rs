//! The tree that links and joints make: every link carried by one joint, but for the root.

use std::collections::{BTreeMap, HashMap, HashSet};

use crate::files::decimals::Decimals;
use crate::files::document::Log;
use crate::files::normal::Normal;
use crate::files::site::Site;
use crate::files::suggest;
use crate::robot::links::assembly::{self, Motion, assemble};
use crate::robot::links::written::{Hold, Matter};
use crate::robot::links::{Assembled, DriveDefaults, MovingJoint};
use crate::robot::urdf::joint::{self, Connection, Joint, Kind, Standstill};
use crate::robot::urdf::link;
use crate::robot::urdf::node::Node;
use crate::robot::urdf::xml::Element;

/// Names of root links listed in a message.
const MOST_NAMED: usize = 4;

/// Joints that mimic each other in a row are followed this far; a cycle of them has no end.
const LONGEST_MIMICRY: usize = 16;

/// What to do about joints that cannot move.
const MOVE: &str = "correct the URDF; hold joints without a drive still (import --lock JOINT=POSITION, in a robot file links.locked); or, \
                    if such numbers stand for what nobody knew, say so and they are no limits: import --unknown-limits, in a robot \
                    file links.unknown_limits = true";

/// A robot as its URDF describes it.
pub(crate) struct Urdf<'a> {
    /// The `<robot>` element, for messages about the whole file.
    pub site: Site<'a>,
    pub name: Option<&'a str>,
    /// Depth first, in the order of the file: parents before children.
    pub joints: Vec<Joint<'a>>,
    /// Name of the link that no joint carries.
    pub root: &'a str,
    /// What the file says.
    pub normal: Normal,
}

/// Joints that are held still, and where [rad or m].
pub(crate) type Locks<'a> = BTreeMap<&'a str, f64>;

/// Links and joints in the order of the file.
struct Parts<'a> {
    links: Vec<(&'a str, Site<'a>, Matter)>,
    connections: Vec<Connection<'a>>,
}

pub(crate) fn read<'a>(root: &'a Element<'a>, log: &'a Log) -> Option<Urdf<'a>> {
    let site = Site { span: root.span.clone(), path: "robot".to_owned(), log };
    let node = Node { element: root, site };
    let name = if node.has("name") { Some(node.text("name", "")?.0) } else { None };
    let parts = parts(root, log)?;
    let (joints, base) = ordered(parts, &node.site)?;
    Some(Urdf { site: node.site, name, joints, root: base, normal: normal(root) })
}

/// The links and joints in the order of the file. What the robot is called is left out.
fn normal(root: &Element<'_>) -> Normal {
    let parts = root.children.iter().filter(|child| matches!(child.name, "link" | "joint"));
    Normal::List(parts.map(Element::normal).collect())
}

/// Every link and joint; all that is wrong with any of them is noted.
fn parts<'a>(root: &'a Element<'a>, log: &'a Log) -> Option<Parts<'a>> {
    let mut parts = Parts { links: Vec::new(), connections: Vec::new() };
    let mut names = HashSet::new();
    let mut sound = Some(());
    for element in &root.children {
        let is_link = element.name == "link";
        if !is_link && element.name != "joint" {
            continue;
        }
        if log.is_full() {
            return None;
        }
        let Some((name, node)) = Node::named(element, log) else {
            sound = None;
            continue;
        };
        if !names.insert((is_link, name)) {
            node.site.error("duplicate", format!("{} stands twice", node.site.path), "names must differ");
            sound = None;
        } else if is_link {
            match link::matter(&node) {
                Some(matter) => parts.links.push((name, node.site, matter)),
                None => sound = None,
            }
        } else {
            match joint::read(name, &node) {
                Some(connection) => parts.connections.push(connection),
                None => sound = None,
            }
        }
    }
    sound.map(|()| parts)
}

/// The joints depth first from the root link, and its name; notes an error if they make no tree.
fn ordered<'a>(parts: Parts<'a>, robot: &Site<'a>) -> Option<(Vec<Joint<'a>>, &'a str)> {
    let Parts { links, connections } = parts;
    let index: HashMap<&str, usize> = links.iter().enumerate().map(|(i, (name, ..))| (*name, i)).collect();
    let find = |(name, site): &(&str, Site<'_>)| {
        let found = index.get(name).copied();
        if found.is_none() {
            let message = format!("{} is {}, which is no link of the file", site.path, suggest::quoted(name));
            site.error("unknown-name", message, suggest::hint(name, links.iter().map(|(name, ..)| *name)));
        }
        found
    };
    // Per link: the joints that it carries, and the one that carries it.
    let mut carries: Vec<Vec<usize>> = vec![Vec::new(); links.len()];
    let mut carrier: Vec<Option<usize>> = vec![None; links.len()];
    let mut children = Vec::new();
    let mut sound = true;
    for (i, connection) in connections.iter().enumerate() {
        if robot.log.is_full() {
            return None;
        }
        let (Some(parent), Some(child)) = (find(&connection.parent), find(&connection.child)) else {
            sound = false;
            continue;
        };
        if let Some(other) = carrier[child] {
            let (name, site) = &connection.child;
            let message = format!(
                "{}: link {} is the child of joint {} already",
                connection.joint.site.path,
                suggest::quoted(name),
                suggest::quoted(connections[other].joint.name)
            );
            site.error("not-a-tree", message, "closed chains are not modelled: cut one of the joints");
            sound = false;
            continue;
        }
        carrier[child] = Some(i);
        carries[parent].push(i);
        children.push(child);
    }
    if !sound {
        return None;
    }
    let root = root(&links, &carrier, robot)?;

    // Without recursion: joints still to be visited, with the joint that carries them.
    let mut order = Vec::new();
    let mut pending: Vec<(usize, Option<usize>)> = carries[root].iter().rev().map(|&i| (i, None)).collect();
    while let Some((i, parent)) = pending.pop() {
        let own = order.len();
        order.push((i, parent));
        pending.extend(carries[children[i]].iter().rev().map(|&next| (next, Some(own))));
    }
    if order.len() < connections.len() {
        let mut reached = vec![false; connections.len()];
        for &(i, _) in &order {
            reached[i] = true;
        }
        let stray = reached.iter().position(|reached| !reached).unwrap_or(0);
        let site = &connections[stray].joint.site;
        let message = format!("{} is part of a cycle: it hangs on its own child", site.path);
        site.error("not-a-tree", message, "closed chains are not modelled: cut one of the joints");
        return None;
    }
    let mut joints: Vec<Option<Joint<'a>>> =
        connections.into_iter().map(|connection| Some(connection.joint)).collect();
    let joints: Option<Vec<Joint<'a>>> = order
        .into_iter()
        .map(|(i, parent)| Some(Joint { parent, matter: links[children[i]].2, ..joints[i].take()? }))
        .collect();
    Some((joints?, links[root].0))
}

/// The one link that no joint carries.
fn root(links: &[(&str, Site<'_>, Matter)], carrier: &[Option<usize>], robot: &Site<'_>) -> Option<usize> {
    let roots: Vec<usize> = (0..links.len()).filter(|&i| carrier[i].is_none()).collect();
    match roots.as_slice() {
        [root] => Some(*root),
        [] if links.is_empty() => {
            robot.error(
                "empty",
                "the robot has no link",
                "is it a URDF? xacro files have to be expanded first",
            );
            None
        }
        [] => {
            let message = "no link is the root: every link is the child of a joint";
            robot.error("not-a-tree", message, "the joints make a cycle; cut one of them");
            None
        }
        [_, second, ..] => {
            let mut names: Vec<_> =
                roots.iter().take(MOST_NAMED).map(|&i| suggest::quoted(links[i].0)).collect();
            if roots.len() > MOST_NAMED {
                names.push("…".to_owned());
            }
            let message =
                format!("{} links are the child of no joint, must be one: {}", roots.len(), names.join(", "));
            links[*second].1.error("not-a-tree", message, "connect the others, or remove them");
            None
        }
    }
}

impl<'a> Urdf<'a> {
    /// Notes an error at `site` if there is no joint `name`, or none that moves, and a warning if it cannot be at `q`
    /// [rad or m].
    pub fn can_hold(&self, name: &str, q: f64, site: &Site<'_>) -> Option<()> {
        let Some(joint) = self.joints.iter().find(|joint| joint.name == name) else {
            let message = format!("{}: {} is no joint of the URDF", site.path, suggest::quoted(name));
            let moving = self.joints.iter().filter(|joint| joint.moves());
            site.error("unknown-name", message, suggest::hint(name, moving.map(|joint| joint.name)));
            return None;
        };
        if !joint.moves() {
            let message = format!("{}: {} is a fixed joint", site.path, suggest::quoted(name));
            site.error("lock", message, "only joints that move can be locked");
            return None;
        }
        let lower = joint.drive.position_lower.unwrap_or(f64::NEG_INFINITY);
        let upper = joint.drive.position_upper.unwrap_or(f64::INFINITY);
        if !(lower..=upper).contains(&q) {
            let name = suggest::quoted(name);
            let message =
                format!("{}: {name} is at {q}, outside the limits {lower} to {upper} of the URDF", site.path);
            site.warn("limits", message, "rad, or m for a prismatic joint");
        }
        Some(())
    }

    /// The moving bodies, with the joints in `locks` and those that mimic them held still. `decimals` are the numbers of
    /// the URDF and of the locks. Limits of zero are no limits if they are `unknown_limits`, else they are refused.
    pub fn assemble(self, locks: &Locks<'_>, unknown_limits: bool, decimals: Decimals) -> Option<Assembled> {
        let held = self.held(locks)?;
        if !unknown_limits {
            self.refuse_standstill(&held)?;
        }
        let site = self.site;
        let joints = self.joints.into_iter().zip(held).map(|(joint, held)| fixed_or_moving(joint, held));
        assemble(&joints.collect::<Vec<_>>(), decimals, || {
            site.error("immovable", "no joint of the robot moves", "at least one joint must stay unlocked");
        })
    }

    /// Notes one error for all joints that are not held still and cannot move within their limits.
    fn refuse_standstill(&self, held: &[Option<Hold>]) -> Option<()> {
        let moving = self.joints.iter().zip(held).filter(|(_, held)| held.is_none());
        let still: Vec<_> =
            moving.filter_map(|(joint, _)| Some((joint.name, joint.standstill.as_ref()?))).collect();
        let Some((_, first)) = still.first() else { return Some(()) };
        let line = |(name, Standstill { site, said }): &(&str, &Standstill<'_>)| {
            format!("\n  line {}: joint {}: {said}", site.line(), suggest::quoted(name))
        };
        let lines: String = still.iter().map(line).collect();
        let joints = if still.len() == 1 { "1 joint".to_owned() } else { format!("{} joints", still.len()) };
        let message =
            format!("{joints} cannot move: effort and velocity must be > 0, lower less than upper:{lines}");
        first.site.error("limits", message, MOVE);
        None
    }

    /// Where each joint is held still, if it is; notes an error at one that mimics a joint that moves.
    fn held(&self, locks: &Locks<'_>) -> Option<Vec<Option<Hold>>> {
        let mut sound = Some(());
        let index = self.indices();
        let held = self.joints.iter().map(|joint| {
            let held = self.follow(joint, locks, &index);
            if let (None, Some(mimic)) = (&held, &joint.mimic) {
                let known = index.contains_key(mimic.of);
                let objection = if known {
                    "joints that move together are not modelled"
                } else {
                    "there is no such joint"
                };
                let (path, of) = (&joint.site.path, suggest::quoted(mimic.of));
                let lock = suggest::key(if known { mimic.of } else { joint.name });
                mimic.site.error(
                    "mimic",
                    format!("{path} mimics joint {of}: {objection}"),
                    format!("hold it still: links.locked = {{ {lock} = 0.0 }} in the robot file"),
                );
                sound = None;
            }
            held
        });
        let held = held.collect();
        sound.map(|()| held)
    }

    /// Where `joint` is held, through as many joints as mimic each other.
    fn follow(&self, joint: &Joint<'_>, locks: &Locks<'_>, index: &HashMap<&str, usize>) -> Option<Hold> {
        let (mut mimicry, mut joint) = (Vec::new(), joint);
        for _ in 0..LONGEST_MIMICRY {
            if let Some(&position) = locks.get(joint.name) {
                return Some(Hold { position, mimicry });
            }
            let mimic = joint.mimic.as_ref()?;
            mimicry.push((mimic.multiplier, mimic.offset));
            joint = &self.joints[*index.get(mimic.of)?];
        }
        None
    }

    fn indices(&self) -> HashMap<&str, usize> {
        self.joints.iter().enumerate().map(|(i, joint)| (joint.name, i)).collect()
    }

    /// The joints to lock so that none that moves mimics another: the ones that are mimicked in the end.
    pub fn mimicked(&self, locks: &Locks<'_>) -> Vec<(&'a str, DriveDefaults)> {
        let index = self.indices();
        let mut masters = BTreeMap::new();
        for joint in self.joints.iter().filter(|joint| self.follow(joint, locks, &index).is_none()) {
            let mut last = joint;
            for _ in 0..LONGEST_MIMICRY {
                let Some(next) = last.mimic.as_ref().and_then(|mimic| index.get(mimic.of)) else { break };
                last = &self.joints[*next];
            }
            if last.mimic.is_none() && !std::ptr::eq(last, joint) {
                masters.insert(last.name, last.drive);
            }
        }
        masters.into_iter().collect()
    }
}

fn fixed_or_moving(joint: Joint<'_>, held: Option<Hold>) -> assembly::Joint<'_> {
    let Joint { site, name, kind, parent, frame, axis, drive, matter, .. } = joint;
    let motion = match (kind, held) {
        (Kind::Fixed, _) => Motion::Fixed,
        (Kind::Moving(kind), Some(hold)) => Motion::Held(kind, axis, hold),
        (Kind::Moving(kind), None) => {
            Motion::Moving(MovingJoint { name: name.to_owned(), kind, drive }, axis)
        }
    };
    assembly::Joint { site, parent, motion, frame, matter }
}
