"""Statements to effects: scopes, evaluation of statements, the vocabulary of effects. No robot, no clock."""
