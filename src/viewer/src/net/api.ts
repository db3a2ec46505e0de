// The questions asked over HTTP. Answers are typed by the message schema.
import type { Scale, SessionDetail, SessionList, TaskInfo } from "../messages";

async function get<T>(path: string): Promise<T> {
  const answer = await fetch(path, { headers: { accept: "application/json" } });
  if (!answer.ok) throw new Error(`the trainer answered ${answer.status} to ${path}`);
  return (await answer.json()) as T;
}

async function change<T>(path: string, asked: RequestInit): Promise<T> {
  const answer = await fetch(path, asked);
  if (!answer.ok) throw new Error(`the trainer answered ${answer.status} to ${path}`);
  const said = (await answer.json()) as T & { refused?: string };
  if (said.refused) throw new Error(said.refused);
  return said;
}

export const post = <T>(path: string, body: object): Promise<T> => change(path, { method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(body) });
/// A part of a file.
export const put = <T>(path: string, body: Blob, signal: AbortSignal): Promise<T> => change(path, { method: "PUT", headers: { "content-type": "application/octet-stream" }, body, signal });

export interface ReconcileStatus {
  folder: string;
  datasets: { name: string; report: { verdict: string; effects: string[]; partial: boolean; sentence: string; model: boolean } | null }[];
  job: { state: string; dataset: string; stage: string; share: number; message: string };
}
export const reconcile = {
  status: (): Promise<ReconcileStatus> => get("/api/reconcile"),
  start: (dataset: string): Promise<ReconcileStatus> => post("/api/reconcile/start", { dataset }),
  cancel: (): Promise<ReconcileStatus> => post("/api/reconcile/cancel", {}),
};

export interface CalibrationPoint { value: number; count: number; noise: number; upwards: boolean }
export interface CalibrationFit { good: boolean; why: string; unit: string; gain: number; zero: number; uncertainty: number; residual: number; hysteresis: number; repeatability: number; from: number; to: number }
export interface CalibrationStatus {
  port: string;
  in_use: string;
  run: null | { state: "asking" | "reading" | "done" | "refused"; instruction: string; taken: number; of: number; progress: number; live: number | null; trouble: string; file: string;
    angle: CalibrationPoint[]; force: CalibrationPoint[]; fits?: { angle: CalibrationFit; force: CalibrationFit } };
}
export const calibration = {
  status: (): Promise<CalibrationStatus> => get("/api/calibration"),
  change: (what: string, wish: object): Promise<CalibrationStatus> => post(`/api/calibration/${what}`, wish),
};

export interface CameraStatus {
  there: boolean;
  fixed: string;
  run: null | { state: "starting" | "looking" | "ended" | "done" | "failed"; source: string; square: number; instruction?: string; complete?: boolean; views?: number;
    wishes?: { what: string; granted: boolean }[]; board?: { size: number; tilt_x_deg: number; tilt_y_deg: number } | null; picture?: number; trouble?: string; file?: string;
    result?: null | { residual_px: number; views: number; coverage: number; width: number; height: number; fx: number; fy: number; cx: number; cy: number; uncertainty: number[]; distortion: number[] } };
}
export const camera = {
  status: (): Promise<CameraStatus> => get("/api/camera"),
  change: (what: string, wish: object): Promise<CameraStatus> => post(`/api/camera/${what}`, wish),
};

export interface AnalysisStatus { state: "working" | "ready" | "failed"; document: string; message: string }
export const analysis = (id: string, clamped: string): Promise<AnalysisStatus> =>
  get(`/api/analysis/${encodeURIComponent(id)}${clamped ? `/${encodeURIComponent(clamped)}` : ""}`);

export interface StudyStatus { state: "idle" | "running" | "done" | "cancelled" | "failed"; message: string; at: number; of: number; left_out: { id: string; why: string }[]; tasks: string[] }
export const study = {
  status: (): Promise<StudyStatus> => get("/api/study"),
  start: (chosen: string[], clamped: string[]): Promise<StudyStatus> => post("/api/study/start", { sessions: chosen, clamped }),
  cancel: (): Promise<StudyStatus> => post("/api/study/cancel", {}),
};

export const tasks = (): Promise<{ tasks: TaskInfo[] }> => get("/api/tasks");
export const sessions = (): Promise<SessionList> => get("/api/sessions");
export const session = (id: string): Promise<SessionDetail> => get(`/api/sessions/${encodeURIComponent(id)}`);

export interface Rated { scale: string; rater: string; stored: string; marks: Record<string, number> }
export interface RatingStatus { session: string; task: string; title: string; scales: Scale[]; ratings: Rated[]; trouble: string }
export interface AgreementRow { scale: string; item: string; a: string; b: string; sessions: number; raters: number; same: number | null; bias: number | null; kappa: number | null; kappa_low: number | null; kappa_high: number | null; icc: number | null }
export interface AgreementStatus { statistics: string; agreement: AgreementRow[]; ratings: (Rated & { session: string; task: string })[]; trouble: string }
export const ratings = {
  of: (id: string): Promise<RatingStatus> => get(`/api/ratings/${encodeURIComponent(id)}`),
  put: (id: string, scale: string, rater: string, marks: Record<string, number>): Promise<RatingStatus> => post(`/api/ratings/${encodeURIComponent(id)}`, { rater, scale, marks }),
  agreement: (): Promise<AgreementStatus> => get("/api/agreement"),
};
