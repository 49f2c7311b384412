"""Where methods fail and what each does there: ``make stability`` writes ``docs/stability.md`` and its maps."""
