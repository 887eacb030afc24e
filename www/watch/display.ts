/** What the tool shows of a run: the picture, the numbers beside it, the timeline and the inspector. */

import { controls, element } from './controls.ts';
import { EdgeDrawing } from './edge-drawing.ts';
import type { Graphics } from './graphics.ts';
import { Comparison } from './comparison.ts';
import type { Replacement } from './handover.ts';
import { showDraws, showLegend, type Draws } from './legend.ts';
import { Inspection } from './inspection.ts';
import { LockCount } from './lock-count.ts';
import type { Opened } from './opening.ts';
import type { Phases } from './phases.ts';
import { palette } from './palette.ts';
import { widthOf } from './plan.ts';
import { Panel } from './panel.ts';
import { SLOW } from './player.ts';
import { COLOURED, countStates, type Run } from './run.ts';
import type { SideStates } from './mesh-worker.ts';
import type { Shown } from './shown.ts';
import { SEARCHED, StateSearch } from './state-search.ts';
import { Timeline } from './timeline.ts';
import { SurfaceChoice } from './surface-choice.ts';
import { stillness } from '../shell/stillness.ts';
import { showTransport, type RunStatus } from './transport.ts';
import { flipsBetween } from './flip-animation.ts';
import { unitPositions } from './unit.ts';
import { viewpointOf } from './viewpoint.ts';

/** How the edges are drawn: in colours, plain, or not at all. */
export type EdgeLook = 'coloured' | 'plain' | 'none';

export class Display {
  readonly panel: Panel;
  readonly inspection: Inspection;
  readonly comparison: Comparison;
  readonly surface: SurfaceChoice;
  readonly edgeDrawing: EdgeDrawing;
  /** The stops between the phases of an iteration. */
  phases: Phases | undefined;
  readonly #timeline = new Timeline();
  readonly #graphics: Graphics;
  look: EdgeLook = 'coloured';
  readonly #search = new StateSearch();
  readonly #locks = new LockCount();
  /** The states of a large mesh that were last found. */
  #found: { run: Run; at: number; states: SideStates } | undefined;
  /** Whether the mesh is too large for its states to be known at once, and what the page has said about its picture. */
  #isLarge = false;
  /** Whether they are looked for. */
  #isSearched = false;
  #saysDraws = '';
  /** The number of pictures so far. A picture is dropped when a later one begins. */
  #pictures = 0;
  /** What the last picture showed in colours. */
  #last: { run: Run; at: number; indices: Uint32Array } | undefined;

  /**
   * `seek` is called with the iteration that the user clicks in the table, and `draw` with the ends of an edge that the
   * user draws.
   */
  constructor(graphics: Graphics, seek: (at: number) => void, draw: (from: number, to: number) => void) {
    this.#graphics = graphics;
    this.panel = new Panel(seek);
    this.inspection = new Inspection(() => graphics.scene);
    this.comparison = new Comparison(() => graphics.scene);
    this.surface = new SurfaceChoice(() => graphics.scene);
    this.edgeDrawing = new EdgeDrawing(
      () => graphics.scene,
      draw,
      () => {
        this.inspection.close();
        this.comparison.show(false);
      },
    );
    this.inspection.isPaused = () => this.edgeDrawing.isOn;
  }

  /** Takes the colours of the page. */
  recolour(): void {
    const colours = palette();
    this.#graphics.scene?.setPalette(colours);
    this.panel.setPalette(colours);
  }

  /** Shows the mesh of another run. `isOther`: whether its vertices are others than before. */
  begin(opened: Opened, isOther: boolean): void {
    const { mesh } = opened;
    const { scene } = this.#graphics;
    this.#last = this.#found = undefined;
    this.inspection.close();
    const positions = unitPositions(mesh);
    scene?.setMesh(positions, widthOf(mesh));
    this.surface.begin(opened, isOther);
    if (isOther || !scene?.camera.isLooking) {
      scene?.lookAtAll();
      scene?.camera.lookFrom(viewpointOf(positions, mesh.indices));
    }
    scene?.measureEdges(mesh.indices);
    this.#isLarge = mesh.indices.length > 3 * COLOURED;
    this.#isSearched = this.#isLarge && mesh.indices.length <= 3 * SEARCHED;
    if (isOther) this.look = 'coloured';
    this.phases?.begin();
    this.comparison.begin(mesh.indices);
    this.edgeDrawing.begin(mesh);
    element('no-mesh').hidden = scene !== undefined;
    for (const id of ['beta-label', 'beta-range', 'beta-says', 'deviation-label', 'feature-label']) {
      element(id).hidden = mesh.dimension === 2;
    }
    const hasGroups = 'groups' in mesh && mesh.groups !== undefined;
    element('groups-label').hidden = !hasGroups;
    controls.limit.hidden = mesh.dimension === 2 && !hasGroups;
    this.panel.clear();
  }

  /** Shows no mesh. */
  clear(): void {
    this.#last = this.#found = undefined;
    this.inspection.forget();
    this.edgeDrawing.begin(undefined);
    this.#graphics.scene?.clear();
    this.surface.begin(undefined, true);
    this.panel.clear();
    this.#isLarge = this.#isSearched = false;
    this.#saysDraws = '';
    showDraws(undefined, false, false);
    showLegend(undefined, { isLarge: false, isPlane: false });
    element('no-mesh').hidden = false;
  }

  /** Draws the shown iteration. Returns whether no later picture has begun meanwhile. */
  async draw(shown: Shown): Promise<boolean> {
    const picture = ++this.#pictures;
    const { scene } = this.#graphics;
    if (!scene) return true;
    const states = this.showTriangles(shown);
    try {
      const indices = states && (await shown.run.triangles());
      if (picture !== this.#pictures) return false;
      scene.showEdges(indices, indices && states && (this.phases?.take(shown.run, indices, states) ?? states));
      this.phases?.say();
      this.#turn(shown.run, indices);
      if (indices) this.lookInto(shown, indices);
      return true;
    } catch (error) {
      if (picture === this.#pictures) throw error;
      return false;
    }
  }

  /** The scene has drawn a picture. */
  pictured(): void {
    this.inspection.draw();
    const draws = this.#draws;
    const isColoured = this.look === 'coloured';
    const { isAsInFile } = this.surface;
    const says = `${draws} ${isColoured} ${isAsInFile}`;
    if (says === this.#saysDraws) return;
    this.#saysDraws = says;
    showDraws(draws, isColoured, isAsInFile);
  }

  get #draws(): Draws | undefined {
    const { scene } = this.#graphics;
    if (!this.#isLarge || !scene) return undefined;
    if (this.look === 'none') return 'nothing';
    return ({ all: 'edges', none: 'tints', some: 'both' } as const)[scene.edgesSeen];
  }

  /** Waits until the visitor sees what the page has drawn. */
  async painted(): Promise<void> {
    await this.#graphics.scene?.seen();
  }

  /** Shows how the edges flip from the last picture to this one, if there is one iteration between them. */
  #turn(run: Run, indices: Uint32Array | undefined): void {
    const last = this.#last;
    const { at } = run;
    this.#last = indices && { run, at, indices };
    if (last?.run === run && last.at === at) return;
    const isStep = indices && last?.run === run && Math.abs(last.at - at) === 1 && !stillness.matches;
    if (!isStep) return this.#graphics.scene?.animateFlips(new Uint32Array(), 'not');
    const isBack = at < last.at;
    const flips = isBack ? flipsBetween(indices, last.indices) : flipsBetween(last.indices, indices);
    const slides = Number(controls.speed.value) >= SLOW;
    this.#graphics.scene?.animateFlips(flips, slides ? (isBack ? 'back' : 'on') : 'not');
  }

  /** Draws the triangles. Returns the states of their edges if these are drawn one by one, as those of a small mesh. */
  showTriangles({ run, opened }: Shown): Uint8Array | undefined {
    const isColoured = this.look === 'coloured';
    const states = isColoured ? run.states : undefined;
    const sides = isColoured && !states ? (this.#statesOf(run)?.sides ?? run.flipping) : undefined;
    this.#graphics.scene?.show(run.drawn, opened.mesh.indices.length, this.look !== 'none' && !states, sides);
    return states;
  }

  /** Looks for the states of the edges of a large mesh, and shows them. */
  async findStates(shown: Shown, isOutdated: () => boolean): Promise<void> {
    const { run } = shown;
    if (run.states || this.look !== 'coloured') return;
    const { at } = run;
    const states = await this.#search.find(shown, isOutdated);
    if (!states || isOutdated() || run.at !== at) return;
    // Each array has a buffer of its own on the GPU.
    const kept = this.#found?.run === run ? this.#found.states.sides : undefined;
    if (kept) {
      kept.set(states.sides);
      states.sides = kept;
    }
    this.#found = { run, at, states };
    this.inspection.know(states.states);
    this.showTriangles(shown);
    this.#showLegend(shown, undefined);
  }

  /** Counts the locked edges of the run, for the legend. */
  async countLocks(shown: Shown): Promise<void> {
    await this.#locks.count(shown);
  }

  /** The states at the shown iteration of a large mesh, if they have been found. */
  #statesOf(run: Run): SideStates | undefined {
    return this.#found?.run === run && this.#found.at === run.at ? this.#found.states : undefined;
  }

  #showLegend(shown: Shown, nonManifold: number | undefined): void {
    const { run, opened } = shown;
    const counts = run.states ? countStates(run.states, nonManifold) : this.#statesOf(run)?.counts;
    const isLarge = this.#isSearched && this.look === 'coloured';
    showLegend(counts, { isLarge, isPlane: opened.mesh.dimension === 2, locks: this.#locks.of(shown) });
  }

  /** Measures the edges of these triangles on screen from now on. */
  measureEdges(indices: Uint32Array): void {
    const { scene } = this.#graphics;
    scene?.measureEdges(indices);
    // Then the page says what is seen of edges.
    if (this.#isLarge) scene?.redraw();
  }

  /** Looks one iteration ahead in a large mesh, and shows the edges that flip in it. */
  async lookAhead(shown: Shown): Promise<void> {
    if (shown.run.states || this.look !== 'coloured') return;
    if (await shown.run.lookAhead()) this.showTriangles(shown);
  }

  /** Lets the user inspect the edges of these triangles. */
  lookInto({ run, opened, settings }: Shown, indices: Uint32Array): void {
    const { plan: mesh, extras } = opened;
    const states = run.states ?? this.#statesOf(run)?.states;
    this.inspection.show({ mesh, extras, indices, states, limits: settings });
  }

  /** `fingerprint` belongs to the shown triangles, once it is known. */
  showNumbers(shown: Shown, status: RunStatus, fingerprint?: string): void {
    const { run, opened, settings } = shown;
    this.panel.showIterations(run.iterations, run.at);
    this.panel.showFacts(opened.plan, run, status.summary, settings.maxNormalAngle, fingerprint);
    this.#showLegend(shown, status.summary?.nonManifoldEdges);
    this.showTransport(status);
  }

  showTransport(status: RunStatus): void {
    showTransport(this.#timeline, status);
    this.phases?.say();
  }

  /** Shows the same run on another engine. */
  replaceRun(shown: Shown, { run }: Replacement): void {
    this.showTriangles({ ...shown, run });
    this.panel.showTimes(run.iterations);
  }
}
