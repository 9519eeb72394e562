//! Flexure's side of `benches/peers/run.py` and of `benches/instructions.py`: works by name.
//!
//! `peers model` prints the robots and gains as JSON; `peers time WORK FILE OUT MILLISECONDS` does a work for each line of
//! inputs, f64 in the machine's own bytes, writes what came out and prints the ns of one; `peers repeat WORK TIMES` only does it.
//! The work `loop-SCENARIO` is a control period of a built-in scenario: `peers time loop-two-link-everything - /dev/null 500`.

mod calls;
mod clock;
mod model;
mod motions;

use std::error::Error;
use std::fs;

use calls::Call;
use motions::Motion;

/// Does a work for the line `i` of inputs.
enum Work {
    Call(Call),
    Motion(Motion),
}

fn work(name: &str) -> Result<Work, Box<dyn Error>> {
    if let Some(call) = calls::call(name)? {
        return Ok(Work::Call(call));
    }
    Ok(Work::Motion(motions::motion(name)?.ok_or_else(|| format!("no work {name}"))?))
}

fn time(name: &str, file: &str, out: &str, milliseconds: u64) -> Result<(), Box<dyn Error>> {
    let (ns, results) = match work(name)? {
        Work::Call(mut call) => {
            let inputs = numbers(&fs::read(file)?);
            let lines = inputs.len() / call.inputs;
            let mut results = vec![0.0; lines * call.outputs];
            let (of_inputs, of_outputs) = (call.inputs * call.lines, call.outputs * call.lines);
            let mut pass = || {
                for (line, result) in inputs.chunks_exact(of_inputs).zip(results.chunks_exact_mut(of_outputs))
                {
                    (call.run)(line, result);
                }
            };
            (clock::least(milliseconds, &mut pass) / lines as f64, results)
        }
        Work::Motion(mut motion) => {
            let result = motion.run(motions::SECOND)?;
            let (mut failure, pass) = (Ok(()), motion.pass);
            let ns = clock::least(milliseconds, &mut || {
                failure = motion.run(pass).map(drop);
            });
            failure?;
            (ns / (pass * motion.robots) as f64, result)
        }
    };
    fs::write(out, results.iter().flat_map(|x| x.to_ne_bytes()).collect::<Vec<_>>())?;
    println!("{ns}");
    Ok(())
}

fn repeat(name: &str, times: usize) -> Result<(), Box<dyn Error>> {
    match work(name)? {
        Work::Call(mut call) => {
            // As many inputs however often: what is before the work must not grow with it.
            let inputs: Vec<f64> = (0..16 * call.inputs).map(|i| (i as f64).sin()).collect();
            let mut result = vec![0.0; call.outputs * call.lines];
            for line in inputs.chunks_exact(call.inputs * call.lines).cycle().take(times) {
                (call.run)(line, &mut result);
            }
            std::hint::black_box(&result);
        }
        Work::Motion(mut motion) => drop(motion.run(times)?),
    }
    Ok(())
}

fn numbers(bytes: &[u8]) -> Vec<f64> {
    bytes.as_chunks().0.iter().map(|&bytes| f64::from_ne_bytes(bytes)).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match &arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["model"] => model::print(),
        ["time", name, file, out, milliseconds] => time(name, file, out, milliseconds.parse()?),
        ["repeat", name, times] => repeat(name, times.parse()?),
        _ => Err("peers model | time WORK FILE OUT MILLISECONDS | repeat WORK TIMES".into()),
    }
}
