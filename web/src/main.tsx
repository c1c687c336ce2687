import { render } from "preact";

import "./styles/variables.css";
import "./styles/base.css";
import "./styles/controls.css";
import "./styles/shell.css";
import { goLive } from "./api/live";
import { watchAlarms } from "./shell/alarm_sound";
import { Shell } from "./Shell";

const page = document.getElementById("page");
if (page) render(<Shell />, page);
goLive();
watchAlarms();
