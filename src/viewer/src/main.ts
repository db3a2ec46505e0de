import { App, type PageMaker } from "./app";
import { AgreementPage } from "./ui/agreement_page";
import { LaboratoryPage } from "./ui/laboratory_page";
import { LivePage } from "./ui/live_page";
import { MomentsPage } from "./ui/moments_page";
import { RatePage } from "./ui/rate_page";
import { RatingPage } from "./ui/rating_page";
import { ReplayPage } from "./ui/replay_page";
import { ResultPage } from "./ui/result_page";
import { SessionsPage } from "./ui/sessions_page";
import { StudyPage } from "./ui/study_page";
import { TasksPage } from "./ui/tasks_page";
import "./style.css";

const pages: Record<string, PageMaker> = {
  "": (app) => new TasksPage(app),
  agreement: (app) => new AgreementPage(app),
  laboratory: (app) => new LaboratoryPage(app),
  live: (app) => new LivePage(app),
  moments: (app, id) => new MomentsPage(app, id),
  rate: (app, id) => new RatePage(app, id),
  rating: (app) => new RatingPage(app),
  result: (app, id) => new ResultPage(app, id),
  replay: (app, id) => new ReplayPage(app, id),
  sessions: (app) => new SessionsPage(app),
  study: (app) => new StudyPage(app),
  watch: (app, id) => new ReplayPage(app, id, true),
};

new App(document.getElementById("app")!, pages).start();
