//! Generates the list of lint rules from the files of a folder: each file is one rule.

fn main() -> std::io::Result<()> {
    labspec_finding::list_rules("src/rules", "ALL")
}
