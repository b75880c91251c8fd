//! Initialization: the information and settings that the editor sends, and the capabilities of this server.

use super::lenses::{CHECK, PROVE};
use lsp_types::{
    CodeActionKind, CodeActionOptions, CodeActionProviderCapability, CodeLensOptions, CompletionOptions,
    ExecuteCommandOptions, FoldingRangeProviderCapability, HoverProviderCapability, InitializeResult, OneOf,
    PositionEncodingKind, RenameOptions, SaveOptions, ServerCapabilities, ServerInfo, SignatureHelpOptions,
    TextDocumentSyncCapability, TextDocumentSyncKind, TextDocumentSyncOptions, TextDocumentSyncSaveOptions,
    Uri, WorkspaceFolder,
};
use serde::Deserialize;
use serde_json::Value;

/// The part of `InitializeParams` that this server reads. The capabilities of the editor are not parsed, so that editors
/// newer than the types of `lsp_types` work as well.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct ClientSetup {
    root_uri: Option<Uri>,
    workspace_folders: Option<Vec<WorkspaceFolder>>,
    /// The settings of this server.
    pub(super) initialization_options: Option<Value>,
    /// What the editor can do. Only single entries are read.
    capabilities: Option<Value>,
}

/// What the editor can do at the request of the server.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct EditorSupport {
    /// Whether it applies edits.
    pub(super) applies_edits: bool,
    /// Whether it asks for lenses again.
    pub(super) refreshes_lenses: bool,
}

impl ClientSetup {
    /// What the editor can do.
    pub(super) fn support(&self) -> EditorSupport {
        let can = |path: &str| {
            self.capabilities.as_ref().and_then(|all| all.pointer(path)).and_then(Value::as_bool)
                == Some(true)
        };
        EditorSupport {
            applies_edits: can("/workspace/applyEdit"),
            refreshes_lenses: can("/workspace/codeLens/refreshSupport"),
        }
    }

    /// The folders that are open in the editor.
    pub(super) fn roots(&self) -> Vec<&Uri> {
        match self.workspace_folders.as_deref() {
            None | Some([]) => self.root_uri.iter().collect(),
            Some(folders) => folders.iter().map(|folder| &folder.uri).collect(),
        }
    }
}

/// The settings of the user.
#[derive(Clone, Copy, Debug)]
pub(super) struct EditorSettings {
    /// Whether units are displayed after fields.
    pub(super) units: bool,
    /// Whether labs are run when a lesson is saved.
    pub(super) run_on_save: bool,
    /// Whether the results of runs are displayed above them.
    pub(super) lens_values: bool,
    /// Whether claims are offered for numbers without one.
    pub(super) lens_proofs: bool,
}

impl Default for EditorSettings {
    fn default() -> EditorSettings {
        EditorSettings { units: false, run_on_save: true, lens_values: true, lens_proofs: true }
    }
}

impl EditorSettings {
    /// Applies the settings in a message; others keep their values.
    ///
    /// # Errors
    /// A value has the wrong type; then nothing changes.
    pub(super) fn update(&mut self, mut message: Value) -> Result<(), serde_json::Error> {
        // The settings are in a section with the name of the server, or at the top level.
        let section = message.get_mut("labspec").map(Value::take);
        let settings = section.unwrap_or(message);
        let Some(settings) = serde_json::from_value::<Option<ClientSettings>>(settings)? else {
            return Ok(());
        };
        let units = settings.inlay_hints.and_then(|hints| hints.units);
        self.units = units.unwrap_or(self.units);
        self.run_on_save = settings.run_on_save.unwrap_or(self.run_on_save);
        if let Some(lens) = settings.code_lens {
            self.lens_values = lens.values.unwrap_or(self.lens_values);
            self.lens_proofs = lens.proofs.unwrap_or(self.lens_proofs);
        }
        Ok(())
    }
}

/// The settings as editors send them.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct ClientSettings {
    inlay_hints: Option<InlayHintSettings>,
    run_on_save: Option<bool>,
    code_lens: Option<CodeLensSettings>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct CodeLensSettings {
    values: Option<bool>,
    proofs: Option<bool>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct InlayHintSettings {
    units: Option<bool>,
}

/// The capabilities of this server.
pub(super) fn initialize_result() -> InitializeResult {
    let sync = TextDocumentSyncOptions {
        open_close: Some(true),
        change: Some(TextDocumentSyncKind::INCREMENTAL),
        save: Some(TextDocumentSyncSaveOptions::SaveOptions(SaveOptions { include_text: Some(false) })),
        ..TextDocumentSyncOptions::default()
    };
    let completion = CompletionOptions {
        trigger_characters: Some([".", "\"", "'", "("].map(String::from).to_vec()),
        ..CompletionOptions::default()
    };
    let rename =
        RenameOptions { prepare_provider: Some(true), work_done_progress_options: Default::default() };
    let code_actions = CodeActionOptions {
        code_action_kinds: Some(vec![CodeActionKind::QUICKFIX, CodeActionKind::SOURCE_FIX_ALL]),
        ..CodeActionOptions::default()
    };
    let signature_help = SignatureHelpOptions {
        trigger_characters: Some(["(", ","].map(String::from).to_vec()),
        retrigger_characters: None,
        work_done_progress_options: Default::default(),
    };
    let commands = ExecuteCommandOptions {
        commands: [CHECK, PROVE].map(String::from).to_vec(),
        work_done_progress_options: Default::default(),
    };
    let capabilities = ServerCapabilities {
        position_encoding: Some(PositionEncodingKind::UTF16),
        text_document_sync: Some(TextDocumentSyncCapability::Options(sync)),
        completion_provider: Some(completion),
        hover_provider: Some(HoverProviderCapability::Simple(true)),
        definition_provider: Some(OneOf::Left(true)),
        references_provider: Some(OneOf::Left(true)),
        rename_provider: Some(OneOf::Right(rename)),
        code_action_provider: Some(CodeActionProviderCapability::Options(code_actions)),
        inlay_hint_provider: Some(OneOf::Left(true)),
        document_symbol_provider: Some(OneOf::Left(true)),
        folding_range_provider: Some(FoldingRangeProviderCapability::Simple(true)),
        document_formatting_provider: Some(OneOf::Left(true)),
        document_range_formatting_provider: Some(OneOf::Left(true)),
        signature_help_provider: Some(signature_help),
        code_lens_provider: Some(CodeLensOptions { resolve_provider: Some(false) }),
        execute_command_provider: Some(commands),
        ..ServerCapabilities::default()
    };
    let version = Some(env!("CARGO_PKG_VERSION").to_string());
    InitializeResult { capabilities, server_info: Some(ServerInfo { name: "labspec".to_string(), version }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn settings_are_taken_alone_or_in_a_section() {
        let mut settings = EditorSettings::default();
        for (message, units, run_on_save) in [
            (json!({"inlayHints": {"units": true}}), true, true),
            (json!({"labspec": {"runOnSave": false}}), true, false),
            (json!({"runOnSave": "yes", "inlayHints": {"units": false}}), true, false),
            (json!(null), true, false),
            (json!({"labspec": {"inlayHints": {"units": false}}, "other": 3}), false, false),
        ] {
            assert_eq!(settings.update(message.clone()).is_err(), message["runOnSave"] == "yes");
            assert_eq!((settings.units, settings.run_on_save), (units, run_on_save), "{message}");
        }
    }

    #[test]
    fn an_editor_names_its_folders() {
        let roots = |params: Value| {
            let setup: ClientSetup = serde_json::from_value(params).unwrap();
            setup.roots().into_iter().map(|uri| uri.as_str().to_string()).collect::<Vec<_>>()
        };
        let folders = json!([{"uri": "file:///a", "name": "a"}, {"uri": "file:///b", "name": "b"}]);
        assert_eq!(
            roots(json!({"rootUri": "file:///c", "workspaceFolders": folders})),
            ["file:///a", "file:///b"]
        );
        assert_eq!(roots(json!({"rootUri": "file:///c", "workspaceFolders": []})), ["file:///c"]);
        assert_eq!(roots(json!({"rootUri": null, "workspaceFolders": null, "capabilities": 3})), [""; 0]);
    }
}
