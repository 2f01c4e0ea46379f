//! Effects of a user's own, from the file of `--effects`, beside those of the catalogue.

use std::path::Path;

use anyhow::anyhow;
use pam_artifact::{Input, InputRole};
use pam_muscle::effects::sentence::custom_effects;
use pam_muscle::effects::{CATALOGUE, Effect, Page, effect};
use pam_recording::sha256_hex;
use pam_recording::spelling::unreadable;

/// Effects of `--effects`.
#[derive(Debug, Default)]
pub(crate) struct OwnEffects {
    /// The effects, in the order of the file.
    pub(crate) effects: Vec<&'static dyn Effect>,
    /// The file, for the inputs of an artifact.
    pub(crate) input: Option<Input>,
}

impl OwnEffects {
    /// Reads `path`; nothing where there is none.
    pub(crate) fn read(path: Option<&Path>) -> anyhow::Result<Self> {
        let Some(path) = path else { return Ok(Self::default()) };
        let shown = path.display();
        let text = std::fs::read_to_string(path)
            .map_err(|reason| anyhow!("cannot read {shown}: {}", unreadable(path, &reason)))?;
        let effects = custom_effects(&text).map_err(|fault| anyhow!("{shown}: {fault}"))?;
        let input =
            Input { path: shown.to_string(), sha256: sha256_hex(text.as_bytes()), role: InputRole::Configuration };
        Ok(Self { effects, input: Some(input) })
    }

    /// Every effect by its id: those of the catalogue, then the user's own.
    pub(crate) fn all(&self) -> impl Iterator<Item = &'static dyn Effect> {
        CATALOGUE.iter().chain(&self.effects).copied()
    }

    /// The effect called `id`.
    pub(crate) fn find(&self, id: &str) -> Option<&'static dyn Effect> {
        effect(id).or_else(|| self.effects.iter().copied().find(|effect| effect.page().id == id))
    }

    /// Its page; an effect without a name has none.
    pub(crate) fn page(&self, id: &str) -> Option<&'static Page> {
        self.find(id).map(|effect| effect.page())
    }

    /// The effect called `id`, or what it may have been meant for.
    pub(crate) fn known(&self, id: &str) -> anyhow::Result<&'static dyn Effect> {
        self.all().find(|effect| effect.page().id == id).ok_or_else(|| {
            let near = match pam_cli::nearest(id, self.all().map(|effect| effect.page().id)) {
                Some(near) => format!("did you mean {near}?"),
                None => "pam-diagnose --explain all lists them".to_owned(),
            };
            anyhow!("no effect is called \"{id}\"; {near}")
        })
    }
}
