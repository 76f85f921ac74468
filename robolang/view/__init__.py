"""Pictures for people: the page that replays a run, plots, films, and the robot live."""
