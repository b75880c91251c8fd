//! A rule is a file: the list of them is made from the folder.

fn main() -> std::io::Result<()> {
    labspec_finding::list_rules("src/rules", "ALL")
}
