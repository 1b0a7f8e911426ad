//! FMUs by the crate fmi: each argument is a job (README.md), for each a line says how it went.

use fmi::fmi2::import::Fmi2Import;
use fmi::fmi2::instance::{CoSimulation as _, Common as _};
use fmi::fmi3::import::Fmi3Import;
use fmi::fmi3::{CoSimulation as _, Common as _, Fmi3Model, GetSet as _};
use fmi::traits::FmiImport as _;
use std::collections::HashMap;
use std::error::Error;
use std::io::{Read as _, Write};

type Done = Result<(), Box<dyn Error>>;

/// Attributes of variables in FMI 3 that fmi-schema 0.8.0 does not know; nor does it know the
/// ampere, so the definitions of units have to go, too.
const UNKNOWN: [&str; 3] = [" unit=\"", " displayUnit=\"", " nominal=\""];

/// Variables of one type: their references, and the places of their elements in a row.
#[derive(Default)]
struct Group {
    references: Vec<u32>,
    places: Vec<usize>,
}

struct Job {
    keys: HashMap<String, String>,
    groups: Vec<(String, Group)>,
    width: usize,
}

impl Job {
    fn read(file: &str) -> Result<Job, Box<dyn Error>> {
        let mut job = Job { keys: HashMap::new(), groups: Vec::new(), width: 0 };
        for line in std::fs::read_to_string(file)?.lines() {
            let parts: Vec<&str> = line.split('\t').collect();
            if parts[0] != "value" {
                job.keys.insert(parts[0].to_string(), parts[1].to_string());
                continue;
            }
            let at = match job.groups.iter().position(|g| g.0 == parts[1]) {
                Some(at) => at,
                None => {
                    job.groups.push((parts[1].to_string(), Group::default()));
                    job.groups.len() - 1
                }
            };
            let group = &mut job.groups[at].1;
            group.references.push(parts[2].parse()?);
            for _ in 0..parts[3].parse::<usize>()? {
                group.places.push(job.width);
                job.width += 1;
            }
        }
        Ok(job)
    }

    /// Step through the job; `read` gives the values of a group, `step` advances.
    fn through<I>(
        &self,
        instance: &mut I,
        step: impl Fn(&mut I, f64, f64) -> Done,
        read: impl Fn(&mut I, &str, &[u32], usize) -> Result<Vec<f64>, Box<dyn Error>>,
    ) -> Done {
        let size: f64 = self.keys["step"].parse()?;
        let steps: usize = self.keys["steps"].parse()?;
        let mut out = std::io::BufWriter::new(std::fs::File::create(&self.keys["out"])?);
        for k in 0..=steps {
            if k > 0 {
                step(instance, (k - 1) as f64 * size, size)?;
            }
            let mut row = vec![0.0f64; self.width];
            for (kind, group) in &self.groups {
                let values = read(instance, kind, &group.references, group.places.len())?;
                for (place, value) in group.places.iter().zip(values) {
                    row[*place] = value;
                }
            }
            for value in row {
                out.write_all(&value.to_le_bytes())?;
            }
        }
        Ok(out.flush()?)
    }
}

fn fmi2(job: &Job) -> Done {
    let import: Fmi2Import = fmi::import::from_path(&job.keys["fmu"])?;
    let mut one = import.instantiate_cs("one", false, false)?;
    one.setup_experiment(None, 0.0, None)?;
    one.enter_initialization_mode()?;
    one.exit_initialization_mode()?;
    job.through(
        &mut one,
        |i, time, size| Ok(i.do_step(time, size, true).map(|_| ())?),
        |i, kind, references, count| {
            let (mut reals, mut whole) = (vec![0.0; count], vec![0; count]);
            match kind {
                "Real" => i.get_real(references, &mut reals)?,
                "Integer" => i.get_integer(references, &mut whole)?,
                _ => i.get_boolean(references, &mut whole)?,
            };
            if kind != "Real" {
                reals = whole.iter().map(|&x| x as f64).collect();
            }
            Ok(reals)
        },
    )?;
    one.terminate()?;
    Ok(())
}

macro_rules! values {
    ($instance:ident.$get:ident, $references:ident, $count:ident, $type:ty) => {{
        let mut read = vec![<$type>::default(); $count];
        $instance.$get($references, &mut read)?;
        read.iter().map(|&x| x as f64).collect()
    }};
}

/// A text without what begins and ends so.
fn without(text: &str, begin: &str, end: &str) -> String {
    let mut parts = text.split(begin);
    let mut left = parts.next().unwrap_or("").to_string();
    for part in parts {
        left += part.split_once(end).map_or("", |(_, rest)| rest);
    }
    left
}

/// The archive with a description that the crate can read.
fn plain(fmu: &str) -> Result<Fmi3Import, Box<dyn Error>> {
    let mut archive = zip::ZipArchive::new(std::fs::File::open(fmu)?)?;
    let mut text = String::new();
    archive.by_name("modelDescription.xml")?.read_to_string(&mut text)?;
    text = without(&text, "<UnitDefinitions>", "</UnitDefinitions>");
    for begin in UNKNOWN {
        text = without(&text, begin, "\"");
    }
    let folder = tempfile::tempdir()?;
    archive.extract(&folder)?;
    Ok(Fmi3Import::new(folder, &text)?)
}

fn fmi3(job: &Job) -> Result<&'static str, Box<dyn Error>> {
    let fmu = &job.keys["fmu"];
    let (import, told): (Fmi3Import, _) = match fmi::import::from_path(fmu) {
        Ok(import) => (import, "ok"),
        Err(_) => (plain(fmu)?, "ok\twithout units and nominal values"),
    };
    let mut one = import.instantiate_cs("one", false, false, false, false, &[])?;
    one.enter_initialization_mode(None, 0.0, None)?;
    one.exit_initialization_mode()?;
    job.through(
        &mut one,
        |i, time, size| {
            let (mut event, mut end, mut early, mut last) = (false, false, false, 0.0);
            i.do_step(time, size, true, &mut event, &mut end, &mut early, &mut last)?;
            Ok(())
        },
        |i, kind, references, count| {
            Ok(match kind {
                "Float64" => values!(i.get_float64, references, count, f64),
                "Float32" => values!(i.get_float32, references, count, f32),
                "Int8" => values!(i.get_int8, references, count, i8),
                "UInt8" => values!(i.get_uint8, references, count, u8),
                "Int16" => values!(i.get_int16, references, count, i16),
                "UInt16" => values!(i.get_uint16, references, count, u16),
                "Int32" => values!(i.get_int32, references, count, i32),
                "UInt32" => values!(i.get_uint32, references, count, u32),
                "Int64" => values!(i.get_int64, references, count, i64),
                "UInt64" => values!(i.get_uint64, references, count, u64),
                _ => {
                    let mut read = vec![false; count];
                    i.get_boolean(references, &mut read)?;
                    read.iter().map(|&x| x as u8 as f64).collect()
                }
            })
        },
    )?;
    one.terminate()?;
    Ok(told)
}

fn main() {
    for file in std::env::args().skip(1) {
        let done = Job::read(&file).and_then(|job| match job.keys["fmi"].as_str() {
            "2" => fmi2(&job).map(|_| "ok"),
            _ => fmi3(&job),
        });
        let told = done.map_or_else(|e| e.to_string().replace('\n', " "), |told| told.to_string());
        println!("{file}\t{told}");
    }
}
