//! The published schema of certificates is that of the types that write them.

use std::path::Path;

use super::certificate::Certificate;

/// `FLEXURE_WRITE=1 cargo test --release -p flexure --lib schema` writes the file anew.
#[test]
fn the_published_schema_is_that_of_the_types() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/certificate.schema.json");
    let schema = serde_json::to_string_pretty(&schemars::schema_for!(Certificate)).unwrap() + "\n";
    if std::env::var_os("FLEXURE_WRITE").is_some() {
        std::fs::write(&path, &schema).unwrap();
    }
    let published = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(published == schema, "{} is out of date: FLEXURE_WRITE=1 writes it anew", path.display());
}
