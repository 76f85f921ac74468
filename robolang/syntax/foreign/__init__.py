"""Words and lines of other robot languages, what they mean there, and the statement to write here."""
