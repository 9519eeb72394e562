//! A robot file whose numbers are identified: read with gaps, written with what was found and everything else as it was.

use std::fmt::Write as _;
use std::ops::Range;
use std::path::Path;

use super::gaps::{GAP, KEPT, filled, gaps};
use super::outcome::{Estimate, Identified};
use super::parameters::Parameter;
use crate::files::base::Base;
use crate::files::source::{self, Source};
use crate::files::{Outside, Problem, Problems, ROBOTS, bounds, builtin, suggest};
use crate::robot::{Robot, document};

/// A robot file with its text.
#[derive(Clone, Debug)]
pub struct RobotFile {
    /// The robot, with a number of the usual size in the place of every `nan`.
    pub robot: Robot,
    /// Numbers that the file leaves open: joint, parameter.
    pub gaps: Vec<(usize, Parameter)>,
    /// The text as it is.
    text: String,
}

/// The first line of the comment that holds dry friction.
const FRICTION: &str = "# Dry friction, identified. It belongs into scenarios:";

impl RobotFile {
    /// The robot file at a path, or the built-in robot of that name; numbers to be identified may be `nan`.
    ///
    /// # Errors
    /// With everything that is wrong.
    pub fn load(path_or_name: &str, outside: Outside) -> Result<Self, Problems> {
        let (source, base) = if builtin::is_name(path_or_name) {
            (Source::new(path_or_name, builtin::find(path_or_name, ROBOTS, "robot")?), Base::BuiltIn)
        } else {
            let path = Path::new(path_or_name);
            (source::read(path, bounds::LIMIT)?, Base::of(path, outside))
        };
        let robot = document::read(&Source::new(&source.name, &filled(&source.text)), &base, &[])?;
        let gaps = gaps(&source.text, robot.joints.iter().map(|joint| &*joint.name));
        Ok(Self { robot, gaps, text: source.text.to_string() })
    }

    /// Whether the robot could be read from a file at `path`: files that it names are found from there.
    ///
    /// # Errors
    /// If not.
    pub fn fits(&self, path: &Path, outside: Outside) -> Result<(), Problems> {
        readable(&self.text, path, outside).map(drop)
    }

    /// The text of a file at `path` with the numbers of `found` that are known, their error bars as tolerances and `logs` as
    /// their source; everything else is as it was.
    ///
    /// # Errors
    /// If `[joints]` is no table with a line of its own, or the text could not be read from there.
    pub fn completed(
        &self,
        found: &Identified,
        logs: &[String],
        path: &Path,
        outside: Outside,
    ) -> Result<String, Problems> {
        let mut edits = Edits { file: self, edits: Vec::new() };
        for parameter in KEPT {
            edits.parameter(found, parameter, &logs.join(", "))?;
        }
        for parameter in KEPT {
            edits.tolerance(found, parameter)?;
        }
        edits.edits.extend(friction_comment(&self.text).map(|span| (span, String::new())));
        let mut text = edits.made();
        text.truncate(text.trim_end().len());
        text.push('\n');
        text.push_str(&friction(found));
        readable(&text, path, outside)?;
        Ok(text)
    }
}

fn readable(text: &str, path: &Path, outside: Outside) -> Result<Robot, Problems> {
    let source = Source::new(&path.display().to_string(), &filled(text));
    document::read(&source, &Base::of(path, outside), &[]).map_err(|problems| {
        if problems.iter().any(|problem| matches!(problem.code_word(), "unreadable" | "outside")) {
            let message = format!("{} could not be read where it is to be written", path.display());
            let help = "the robot's file names another: write the result into the folder of that one";
            return Problem::new("unreadable", message, help).into();
        }
        problems
    })
}

/// Where `text` has the comment with dry friction and the blank line before it, and nothing that is not of it.
fn friction_comment(text: &str) -> Option<Range<usize>> {
    let start = text.find(FRICTION)?;
    let own = ["# [[imperfection]]", "# kind = \"friction\"", "# side = ", "# coulomb = ["];
    let lines = text[start..].split_inclusive('\n').enumerate();
    let of_it = lines.take_while(|(k, line)| *k == 0 || own.iter().any(|own| line.starts_with(own)));
    let end = start + of_it.map(|(_, line)| line.len()).sum::<usize>();
    let blank = usize::from(text[..start].ends_with("\n\n"));
    Some(start - blank..end)
}

/// What is to be changed in a text.
struct Edits<'a> {
    file: &'a RobotFile,
    edits: Vec<(Range<usize>, String)>,
}

impl Edits<'_> {
    /// The numbers of a parameter that are known, and where they are from.
    fn parameter(&mut self, found: &Identified, parameter: Parameter, logs: &str) -> Result<(), Problem> {
        let key = parameter.name();
        let robot = &self.file.robot;
        let known: Vec<Option<&Estimate>> = (0..found.joints.len())
            .map(|joint| Some(found.estimate(joint, parameter)).filter(|estimate| estimate.known))
            .collect();
        if known.iter().all(Option::is_none) {
            return Ok(());
        }
        let mut of_all = false;
        for (joint, estimate) in robot.joints.iter().zip(&known) {
            match (robot.places.span(&format!("joints.{}.{key}", joint.name)), estimate) {
                (Some(span), Some(estimate)) => {
                    self.remark(span.end);
                    self.edits.push((span, written(estimate)));
                }
                (None, Some(_)) => of_all = true,
                (_, None) => {}
            }
        }
        if of_all {
            let before = before(robot, parameter).iter().enumerate().map(|(joint, before)| {
                let is_open = self.file.gaps.contains(&(joint, parameter));
                if is_open { GAP.to_owned() } else { format!("{before:?}") }
            });
            let values: Vec<_> =
                known.iter().zip(before).map(|(estimate, before)| estimate.map_or(before, written)).collect();
            let values = format!("[{}]", values.join(", "));
            match robot.places.span(&format!("joints.{key}")) {
                Some(span) => {
                    if known.iter().all(Option::is_some) {
                        self.remark(span.end);
                    }
                    self.edits.push((span, values));
                }
                None => self.insert("joints", &format!("{key} = {values}"))?,
            }
        }
        self.source(found, parameter, &known, logs)
    }

    /// Says `identified` where the comment behind a number that ends at `end` says `assumed`.
    fn remark(&mut self, end: usize) {
        const ASSUMED: &str = "assumed";
        let rest = self.file.text[end..].lines().next().unwrap_or_default();
        let Some(comment) = rest.find('#') else { return };
        let Some(at) = rest[comment..].find(ASSUMED).map(|at| end + comment + at) else { return };
        let edit = (at..at + ASSUMED.len(), "identified".to_owned());
        if !self.edits.contains(&edit) {
            self.edits.push(edit);
        }
    }

    /// How far the numbers of a parameter that are known may be off: their error bars. Others keep what the file says of them.
    fn tolerance(&mut self, found: &Identified, parameter: Parameter) -> Result<(), Problem> {
        let key = parameter.name();
        let robot = &self.file.robot;
        let estimates = (0..found.joints.len()).map(|joint| found.estimate(joint, parameter));
        if estimates.clone().all(|estimate| !estimate.known) {
            return Ok(());
        }
        let named = robot.tolerances.named();
        let before = named.iter().find(|(name, _)| *name == key).map_or(&[][..], |(_, values)| values);
        let value = |(estimate, before): (&Estimate, &f64)| {
            if estimate.known { tolerance(estimate) } else { format!("{before:?}") }
        };
        let values: Vec<_> = estimates.zip(before).map(value).collect();
        let values = format!("[{}]", values.join(", "));
        match robot.places.span(&format!("tolerances.{key}")) {
            Some(span) => self.edits.push((span, values)),
            None if robot.places.has("tolerances") => {
                self.insert("tolerances", &format!("{key} = {values}"))?;
            }
            None => self.append("tolerances", &format!("{key} = {values}")),
        }
        Ok(())
    }

    /// Puts `line` at the end, behind a header of `table` if it is the first.
    fn append(&mut self, table: &str, line: &str) {
        let text = &self.file.text;
        let end = text.trim_end().len();
        let end = end + text[end..].find('\n').map_or(0, |newline| newline + 1);
        let header = format!("\n[{table}]\n");
        let first = !self.edits.iter().any(|(span, new)| span.start == end && new.starts_with(&header));
        let header = if first { header } else { String::new() };
        self.edits.push((end..end, format!("{header}{line}\n")));
    }

    /// Says in `[sources]` where the numbers are from.
    fn source(
        &mut self,
        found: &Identified,
        parameter: Parameter,
        known: &[Option<&Estimate>],
        logs: &str,
    ) -> Result<(), Problem> {
        let (key, places) = (parameter.name(), &self.file.robot.places);
        // Joints whose number has a source of its own.
        let mut of_joints = Vec::new();
        for (joint, estimate) in found.joints.iter().zip(known) {
            let Some(span) = places.span(&format!("sources.joints.{}.{key}", joint.name)) else { continue };
            of_joints.push(&joint.name);
            if let Some(estimate) = estimate {
                let number = format!("{} ± {}", written(estimate), two_digits(estimate.error));
                self.edits.push((span, quoted(&format!("identified: {number} (3 sigma) from {logs}"))));
            }
        }
        if found.joints.iter().all(|joint| of_joints.contains(&&joint.name)) {
            return Ok(());
        }
        let spans = [format!("sources.{key}"), format!("sources.joints.{key}")];
        let span = spans.iter().find_map(|key| places.span(key));
        let earlier = span.clone().and_then(|span| self.file.text.get(span)).unwrap_or_default();
        let earlier = earlier.trim_matches(['"', '\'']);
        let number = |estimate: Option<&Estimate>, joint: &str| match estimate {
            Some(estimate) => format!("{} ± {}", written(estimate), two_digits(estimate.error)),
            None => format!("{joint} not known"),
        };
        let numbers: Vec<_> =
            known.iter().zip(&found.joints).map(|(estimate, joint)| number(*estimate, &joint.name)).collect();
        let mut source = format!("identified: {} (3 sigma) from {logs}", numbers.join(", "));
        if known.iter().any(Option::is_none) {
            source = match earlier.strip_prefix("assumed:") {
                Some(note) => format!(
                    "assumed: {}; {source}",
                    note.split("; identified:").next().unwrap_or(note).trim()
                ),
                None => source,
            };
        }
        let quoted = quoted(&source);
        match span {
            Some(span) => self.edits.push((span, quoted)),
            None if places.has("sources") => self.insert("sources", &format!("{key} = {quoted}"))?,
            None => self.append("sources", &format!("{key} = {quoted}")),
        }
        Ok(())
    }

    /// Puts `line` under the header of `table`, or makes one in front of its first table.
    fn insert(&mut self, table: &str, line: &str) -> Result<(), Problem> {
        let text = &self.file.text;
        let mut at = 0;
        for found in text.split_inclusive('\n') {
            let end = at + found.len();
            let start = found.trim_start();
            if start.starts_with(&format!("[{table}]")) {
                let newline = if found.ends_with('\n') { "" } else { "\n" };
                self.edits.push((end..end, format!("{newline}{line}\n")));
                return Ok(());
            }
            if start.starts_with(&format!("[{table}.")) {
                let header = format!("[{table}]\n");
                let first =
                    !self.edits.iter().any(|(span, new)| *span == (at..at) && new.starts_with(&header));
                let header = if first { header } else { String::new() };
                self.edits.push((at..at, format!("{header}{line}\n")));
                return Ok(());
            }
            at = end;
        }
        let message = format!(
            "cannot write {} into [{table}]: there is no line with that header",
            suggest::quoted(line)
        );
        Err(Problem::new("unsupported", message, "write the table with a header of its own, not inline"))
    }

    /// The text with all changes.
    fn made(mut self) -> String {
        let mut text = self.file.text.clone();
        // From the end on, and what was said first stays in front.
        let mut order: Vec<usize> = (0..self.edits.len()).collect();
        order.sort_by_key(|&i| std::cmp::Reverse((self.edits[i].0.start, i)));
        for i in order {
            let (span, new) = std::mem::take(&mut self.edits[i]);
            text.replace_range(span, &new);
        }
        text
    }
}

/// `source` as a TOML string.
fn quoted(source: &str) -> String {
    format!("\"{}\"", source.replace(['"', '\\'], "'"))
}

/// What the robot has of a parameter.
fn before(robot: &Robot, parameter: Parameter) -> &[f64] {
    match parameter {
        Parameter::Stiffness => &robot.stiffness,
        Parameter::MotorInertia => &robot.motor_inertia,
        Parameter::LinkDamping => &robot.link_damping,
        _ => &robot.motor_damping,
    }
}

/// A value, its last digit at most a tenth of its error.
fn written(estimate: &Estimate) -> String {
    let digits = (estimate.value / estimate.error).log10().ceil().clamp(2.0, 12.0) + 2.0;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "4 to 14")]
    rounded(estimate.value, digits as usize)
}

/// The error bar around what is [`written`], in two digits, rounded up.
fn tolerance(estimate: &Estimate) -> String {
    let written: f64 = written(estimate).parse().unwrap_or(f64::INFINITY);
    let least = estimate.error + (written - estimate.value).abs();
    let step = 10_f64.powf(least.log10().floor() - 1.0);
    let enough = (0..3).map(|k| two_digits(least + f64::from(k) * 0.5 * step));
    enough
        .into_iter()
        .find(|text| text.parse().is_ok_and(|x: f64| x >= least))
        .unwrap_or_else(|| format!("{least:?}"))
}

fn two_digits(x: f64) -> String {
    rounded(x, 2)
}

/// With so many digits, as a TOML float.
fn rounded(x: f64, digits: usize) -> String {
    let rounded: f64 = format!("{x:.*e}", digits - 1).parse().unwrap_or(x);
    format!("{rounded:?}")
}

/// Dry friction as a comment that can be copied into a scenario; nothing of a side of which no joint's is known.
fn friction(found: &Identified) -> String {
    let is_known = |parameter| (0..found.joints.len()).any(|joint| found.estimate(joint, parameter).known);
    let sides = [("link", Parameter::LinkFriction), ("motor", Parameter::MotorFriction)];
    let known: Vec<_> = sides.into_iter().filter(|(_, parameter)| is_known(*parameter)).collect();
    if known.is_empty() {
        return String::new();
    }
    let mut text = format!("\n{FRICTION}\n");
    for (side, parameter) in known {
        let of = |number: &dyn Fn(&Estimate) -> String| {
            let numbers: Vec<_> =
                (0..found.joints.len()).map(|joint| number(found.estimate(joint, parameter))).collect();
            numbers.join(", ")
        };
        let values = of(&|estimate| if estimate.known { written(estimate) } else { "0.0".to_owned() });
        let errors = of(&|estimate| two_digits(estimate.error));
        let all = (0..found.joints.len()).all(|joint| found.estimate(joint, parameter).known);
        let unknown = if all { "" } else { "; 0.0 where the log does not know it" };
        let _ = write!(
            text,
            "# [[imperfection]]\n# kind = \"friction\"\n# side = \"{side}\"\n# coulomb = [{values}]  # ± [{errors}], 3 sigma{unknown}\n"
        );
    }
    text
}
