import { App, type PageMaker } from "./app";
import { LaboratoryPage } from "./ui/laboratory_page";
import { LivePage } from "./ui/live_page";
import { ReplayPage } from "./ui/replay_page";
import { ResultPage } from "./ui/result_page";
import { SessionsPage } from "./ui/sessions_page";
import { StudyPage } from "./ui/study_page";
import { TasksPage } from "./ui/tasks_page";
import "./style.css";

const pages: Record<string, PageMaker> = {
  "": (app) => new TasksPage(app),
  laboratory: (app) => new LaboratoryPage(app),
  live: (app) => new LivePage(app),
  result: (app, id) => new ResultPage(app, id),
  replay: (app, id) => new ReplayPage(app, id),
  sessions: (app) => new SessionsPage(app),
  study: (app) => new StudyPage(app),
};

new App(document.getElementById("app")!, pages).start();
