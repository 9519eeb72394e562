//! Rows as Parquet, and back.

use std::sync::Arc;

use ::bytes::Bytes;
use ::parquet::basic::{Compression, Encoding, LogicalType, Repetition, Type as Physical};
use ::parquet::column::reader::ColumnReader;
use ::parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::{KeyValue, ParquetMetaData, ParquetMetaDataReader};
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::reader::{ChunkReader, FileReader};
use ::parquet::file::serialized_reader::SerializedFileReader;
use ::parquet::file::writer::SerializedFileWriter;
use ::parquet::schema::types::{ColumnPath, Type, TypePtr};

use super::{Outcome, Parameter, Statistics, Sweep, Value};
use crate::files::normal::hexadecimal;
use crate::files::{Problem, Problems, suggest};

/// Keys of what stands beside the rows.
const IDENTITY: &str = "flexure.sweep";
const SHARD: &str = "flexure.shard";
const STATISTICS: &str = "flexure.statistics";
/// How many bytes of the file come before what is said, and their hash with that: what says so is not damaged.
const SEAL: &str = "flexure.seal";

/// A column of rows.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// Whole numbers.
    Whole(Vec<i64>),
    /// Numbers; NaN where there is none.
    Number(Vec<f64>),
    /// Texts.
    Text(Vec<String>),
}

/// Columns of rows with their names.
pub type Columns = Vec<(String, Column)>;

/// What a column has.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Whole,
    Number,
    Text,
}

impl Kind {
    fn column(self, name: &str) -> Result<TypePtr, ParquetError> {
        let (kind, repetition) = match self {
            Self::Whole => (Physical::INT64, Repetition::REQUIRED),
            Self::Number => (Physical::DOUBLE, Repetition::OPTIONAL),
            Self::Text => (Physical::BYTE_ARRAY, Repetition::REQUIRED),
        };
        let text = matches!(self, Self::Text).then_some(LogicalType::String);
        let column = Type::primitive_type_builder(name, kind).with_repetition(repetition);
        Ok(Arc::new(column.with_logical_type(text).build()?))
    }

    fn empty(self) -> Column {
        match self {
            Self::Whole => Column::Whole(Vec::new()),
            Self::Number => Column::Number(Vec::new()),
            Self::Text => Column::Text(Vec::new()),
        }
    }
}

/// What the columns of a sweep have, in the order of their names.
fn kinds(sweep: &Sweep) -> Vec<Kind> {
    let parameter = |parameter: &Parameter| if parameter.is_number() { Kind::Number } else { Kind::Text };
    let mut kinds = vec![Kind::Whole, Kind::Whole, Kind::Text];
    kinds.extend(sweep.parameters().iter().map(parameter));
    kinds.extend(sweep.metrics().iter().map(|_| Kind::Number));
    kinds
}

/// Columns of these names without rows.
///
/// # Errors
/// If there is no such column.
pub(super) fn empty(sweep: &Sweep, names: &[String]) -> Result<Columns, Problem> {
    let (known, kinds) = (sweep.columns(), kinds(sweep));
    let column = |name: &String| {
        let place = known.iter().position(|known| known == name);
        place.map(|i| (name.clone(), kinds[i].empty())).ok_or_else(|| {
            let message = format!("there is no column {}", suggest::quoted(name));
            Problem::new("unknown-name", message, suggest::hint(name, known.iter().map(String::as_str)))
        })
    };
    names.iter().map(column).collect()
}

/// What a file says beside its rows.
pub(super) struct Beside {
    identity: String,
    shard: u64,
    statistics: Statistics,
    /// Bytes of rows, and their hash.
    rows: (usize, String),
}

impl Beside {
    /// The statistics, if the file is of this shard of this sweep.
    pub fn of(self, sweep: &Sweep, shard: u64) -> Result<Statistics, String> {
        if self.identity != sweep.identity() {
            return Err("it is of another sweep".to_owned());
        }
        if self.shard != shard {
            return Err(format!("it has the rows of shard {}", self.shard));
        }
        Ok(self.statistics)
    }
}

/// The file of some rows.
pub(super) fn written(sweep: &Sweep, outcomes: &[Outcome]) -> Result<Vec<u8>, Problems> {
    let statistics = Statistics::of(sweep, outcomes);
    file(sweep, outcomes, &statistics).map_err(|error| {
        Problem::new("parquet", format!("rows make no file: {error}"), "this is a bug of Flexure: report it")
            .into()
    })
}

fn file(sweep: &Sweep, outcomes: &[Outcome], statistics: &Statistics) -> Result<Vec<u8>, ParquetError> {
    let names = sweep.columns();
    let kinds = kinds(sweep);
    let columns = names.iter().zip(&kinds).map(|(name, kind)| kind.column(name)).collect::<Result<_, _>>()?;
    let schema = Arc::new(Type::group_type_builder("rows").with_fields(columns).build()?);
    let said = |key: &str, value: String| KeyValue::new(key.to_owned(), value);
    let beside = vec![
        said(IDENTITY, sweep.identity().to_owned()),
        said(SHARD, outcomes.first().map_or(0, |first| sweep.shard_of(first.row)).to_string()),
        said(STATISTICS, serde_json::to_string(statistics).unwrap_or_default()),
    ];
    let seal = |rows: &[u8]| said(SEAL, sealed(rows, beside.iter().filter_map(|said| said.value.as_deref())));
    let mut properties = WriterProperties::builder()
        .set_compression(Compression::UNCOMPRESSED)
        .set_key_value_metadata(Some(beside.clone()))
        .set_created_by(format!("flexure {}", env!("CARGO_PKG_VERSION")));
    let row = ColumnPath::from(vec![names[0].clone()]);
    properties = properties
        .set_column_dictionary_enabled(row.clone(), false)
        .set_column_encoding(row, Encoding::DELTA_BINARY_PACKED);
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties.build()))?;
    let mut group = writer.next_row_group()?;
    for (i, kind) in kinds.into_iter().enumerate() {
        let Some(mut column) = group.next_column()? else { break };
        match kind {
            Kind::Whole => {
                let whole: Vec<i64> = outcomes
                    .iter()
                    .map(|outcome| (if i == 0 { outcome.row } else { outcome.seed }).cast_signed())
                    .collect();
                column.typed::<Int64Type>().write_batch(&whole, None, None)?;
            }
            Kind::Text => {
                let text = |outcome: &Outcome| match i.checked_sub(3).map(|i| &outcome.values[i]) {
                    None => outcome.status.name().into(),
                    Some(Value::Text(text)) => text.as_str().into(),
                    Some(Value::Number(x)) => x.to_string().as_str().into(),
                };
                let texts: Vec<ByteArray> = outcomes.iter().map(text).collect();
                column.typed::<ByteArrayType>().write_batch(&texts, None, None)?;
            }
            Kind::Number => {
                let number = |outcome: &Outcome| match outcome.values.get(i - 3) {
                    Some(Value::Number(x)) => Some(*x),
                    Some(Value::Text(_)) => None,
                    None => outcome.metrics[i - 3 - outcome.values.len()],
                };
                let numbers: Vec<Option<f64>> = outcomes.iter().map(number).collect();
                let levels: Vec<i16> = numbers.iter().map(|number| i16::from(number.is_some())).collect();
                let numbers: Vec<f64> = numbers.into_iter().flatten().collect();
                column.typed::<DoubleType>().write_batch(&numbers, Some(&levels), None)?;
            }
        }
        column.close()?;
    }
    group.close()?;
    writer.flush()?;
    let seal = seal(writer.inner());
    writer.append_key_value_metadata(seal);
    writer.close()?;
    Ok(bytes)
}

/// How many bytes the rows are, their hash, and a hash of what is said beside them.
fn sealed<'a>(rows: &[u8], said: impl Iterator<Item = &'a str>) -> String {
    let mut hash = hmac_sha256::Hash::new();
    for text in said {
        hash.update((text.len() as u64).to_le_bytes());
        hash.update(text);
    }
    format!("{} {} {}", rows.len(), hexadecimal(hmac_sha256::Hash::hash(rows)), hexadecimal(hash.finalize()))
}

/// What a file says beside its rows: only its end is read.
pub(super) fn beside<R: ChunkReader>(file: &R) -> Result<Beside, String> {
    said(&ParquetMetaDataReader::new().parse_and_finish(file).map_err(|error| error.to_string())?)
}

/// The same from the end of a file alone, without its last eight bytes: those say how long it is.
pub(super) fn beside_of_end(end: &[u8]) -> Result<Beside, String> {
    said(&ParquetMetaDataReader::decode_metadata(end).map_err(|error| error.to_string())?)
}

fn said(metadata: &ParquetMetaData) -> Result<Beside, String> {
    const DAMAGED: &str = "its end is damaged";
    let said = metadata.file_metadata().key_value_metadata();
    let find = |key: &str| {
        let found = said.and_then(|said| said.iter().find(|entry| entry.key == key));
        found.and_then(|entry| entry.value.clone()).ok_or_else(|| format!("it does not say {key}"))
    };
    let (identity, shard, statistics, seal) = (find(IDENTITY)?, find(SHARD)?, find(STATISTICS)?, find(SEAL)?);
    let texts = [&identity, &shard, &statistics].map(String::as_str);
    let expected = sealed(&[], texts.into_iter());
    let (Some((rows, own)), Some((_, expected))) = (seal.rsplit_once(' '), expected.rsplit_once(' ')) else {
        return Err(DAMAGED.to_owned());
    };
    let rows = rows.split_once(' ').and_then(|(count, hash)| Some((count.parse().ok()?, hash.to_owned())));
    match (rows, shard.parse(), serde_json::from_str(&statistics)) {
        (Some(rows), Ok(shard), Ok(statistics)) if own == expected => {
            Ok(Beside { identity, shard, statistics, rows })
        }
        _ => Err(DAMAGED.to_owned()),
    }
}

/// Adds the rows of the file of a shard to `columns`, which have names.
pub(super) fn read(sweep: &Sweep, shard: u64, file: Vec<u8>, columns: &mut Columns) -> Result<(), String> {
    let file = Bytes::from(file);
    let beside = beside(&file)?;
    let (count, hash) = &beside.rows;
    let is_whole = file.get(..*count).is_some_and(|rows| hexadecimal(hmac_sha256::Hash::hash(rows)) == *hash);
    beside.of(sweep, shard)?;
    if !is_whole {
        return Err("its rows are damaged".to_owned());
    }
    read_columns(file, columns).map_err(|error| error.to_string())
}

fn read_columns(file: Bytes, columns: &mut Columns) -> Result<(), ParquetError> {
    let reader = SerializedFileReader::new(file)?;
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    for g in 0..reader.num_row_groups() {
        let group = reader.get_row_group(g)?;
        let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
        for (name, column) in columns.iter_mut() {
            let index = schema.columns().iter().position(|column| column.name() == name);
            let index = index.ok_or_else(|| ParquetError::General(format!("there is no column {name}")))?;
            read_column(group.get_column_reader(index)?, rows, column)?;
        }
    }
    Ok(())
}

fn read_column(reader: ColumnReader, rows: usize, column: &mut Column) -> Result<(), ParquetError> {
    match (reader, column) {
        (ColumnReader::Int64ColumnReader(mut reader), Column::Whole(whole)) => {
            reader.read_records(rows, None, None, whole)?;
        }
        (ColumnReader::DoubleColumnReader(mut reader), Column::Number(numbers)) => {
            let (mut found, mut levels) = (Vec::new(), Vec::new());
            reader.read_records(rows, Some(&mut levels), None, &mut found)?;
            let mut found = found.into_iter();
            numbers.extend(levels.iter().map(|level| match level {
                1 => found.next().unwrap_or(f64::NAN),
                _ => f64::NAN,
            }));
        }
        (ColumnReader::ByteArrayColumnReader(mut reader), Column::Text(texts)) => {
            let mut found: Vec<ByteArray> = Vec::new();
            reader.read_records(rows, None, None, &mut found)?;
            texts.extend(found.iter().map(|text| String::from_utf8_lossy(text.data()).into_owned()));
        }
        _ => return Err(ParquetError::General("a column is of another kind".to_owned())),
    }
    Ok(())
}
