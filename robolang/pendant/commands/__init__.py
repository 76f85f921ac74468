"""The commands of the prompt, one file a group."""
